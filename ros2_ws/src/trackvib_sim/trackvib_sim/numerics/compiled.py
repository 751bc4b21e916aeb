"""How the kernels are compiled: three decorators, so that every kernel follows the same floating-point rules."""

from contextlib import suppress
from functools import partial
from hashlib import sha256
from pathlib import Path

import numba

_PACKAGE = Path(__file__).parents[1]


def _forget_stale_kernels():
    """Remove the kernels beside the sources that were compiled from other sources.

    numba looks at the file of a compiled function, not at those of the functions that it calls: an old kernel would
    be used with new physics beside it. Where NUMBA_CACHE_DIR is set, as by `./trackvib`, its owner sees to that.
    """
    sources = sorted(_PACKAGE.rglob("*.py"))
    key = sha256(b"".join(bytes(source.relative_to(_PACKAGE)) + source.read_bytes() for source in sources)).hexdigest()
    note = _PACKAGE / "__pycache__" / "kernels_of"
    with suppress(OSError):
        if note.read_text() == key:
            return
    with suppress(OSError):  # where nothing can be written beside the sources, numba keeps kernels elsewhere
        for kernel_file in _PACKAGE.rglob("__pycache__/*.nb[ic]"):
            kernel_file.unlink(missing_ok=True)
        note.parent.mkdir(exist_ok=True)
        note.write_text(key)


if not numba.config.CACHE_DIR:
    _forget_stale_kernels()

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
