"""How the kernels are compiled: one decorator, so that every kernel follows the same floating-point rules."""

from functools import partial

import numba

# Reassociation and fused multiply-add are allowed (they double the speed of the sweeps); "no NaNs" and "no
# infinities" are not, because a run is watched for non-finite values.
kernel = partial(
    numba.njit,
    cache=True,
    nogil=True,
    error_model="numpy",
    _nrt=False,
    fastmath={"contract", "reassoc", "nsz", "arcp"},
)()
