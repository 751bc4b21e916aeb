"""How the kernels are compiled: three decorators, so that every kernel follows the same floating-point rules."""

from functools import partial

import numba

_OPTIONS = dict(cache=True, nogil=True, error_model="numpy", _nrt=False)

# Reassociation and fused multiply-add are allowed (they double the speed of the sweeps); "no NaNs" and "no
# infinities" are not, because a run is watched for non-finite values.
_FAST = {"contract", "reassoc", "nsz", "arcp"}

# A function that is called from several places or from Python.
kernel = partial(numba.njit, fastmath=_FAST, **_OPTIONS)()
# A part of a kernel: without calls in them, loops over lanes become vector instructions.
inlined = partial(numba.njit, fastmath=_FAST, forceinline=True, **_OPTIONS)()
# The same where the order of the operations is the algorithm.
exact = partial(numba.njit, fastmath={"contract"}, forceinline=True, **_OPTIONS)()
