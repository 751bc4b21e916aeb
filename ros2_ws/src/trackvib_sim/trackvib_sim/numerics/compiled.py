"""How the kernels are compiled: three decorators, so that every kernel follows the same floating-point rules."""

from contextlib import suppress
from functools import cached_property, partial
from hashlib import sha256
from pathlib import Path
from types import FunctionType

import numba
from numba.core.registry import CPUDispatcher

from .processor import target

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
if (_name := target()) is not None:
    numba.config.CPU_NAME = _name
    numba.config.CPU_FEATURES = numba.config.CPU_FEATURES or ""  # those of that name alone

_OPTIONS = dict(nogil=True, error_model="numpy", no_cfunc_wrapper=True, _nrt=False)

# Reassociation and fused multiply-add are allowed (they double the speed of the sweeps); "no NaNs" and "no
# infinities" are not, because a run is watched for non-finite values.
_FAST = {"contract", "reassoc", "nsz", "arcp"}


class _Part(CPUDispatcher):
    """A function for other compiled ones, without the code that takes its arguments from Python.

    Of a function that takes the records of a vehicle this is the larger half. Where Python calls one all the same, the
    function is compiled once more, with that code.
    """

    def __call__(self, *arguments, **named):
        return self._for_python(*arguments, **named)

    @cached_property
    def _for_python(self):
        function = self.py_func
        twin = FunctionType(
            function.__code__, function.__globals__, function.__name__, function.__defaults__, function.__closure__
        )
        twin.__qualname__ = f"{function.__qualname__}.for_python"  # numba keeps it in a file of that name
        return numba.jit(cache=True, **self.targetoptions | {"no_cpython_wrapper": False})(twin)


def _part(fastmath):
    options = _OPTIONS | dict(nopython=True, fastmath=fastmath, forceinline=True, no_cpython_wrapper=True)

    def decorate(function):
        part = _Part(function, targetoptions=options)
        part.enable_caching()
        return part

    return decorate


# A function that is called from several places or from Python.
kernel = partial(numba.njit, cache=True, fastmath=_FAST, **_OPTIONS)()
# A part of a kernel: without calls in them, loops over lanes become vector instructions.
inlined = _part(_FAST)
# The same where the order of the operations is the algorithm.
exact = _part({"contract"})
