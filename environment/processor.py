"""What code is compiled for: a level of x86-64, not the very processor, so that all of one level give the same bits.

Wider vectors add in another order, and the impacts of the tracks amplify what that rounds differently.
"""

import platform
import re
from pathlib import Path

# Names of the compiler, and what /proc/cpuinfo calls that which a level has beyond those below it.
_V3 = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"}
_LEVELS = {"x86-64-v4": _V3 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}, "x86-64-v3": _V3}
_CPU_INFO = Path("/proc/cpuinfo")


def level(cpu_info: str):
    """Return the highest level that a processor has by the text of its /proc/cpuinfo; None below the third."""
    flags = re.search(r"^flags\s*:(.*)$", cpu_info, re.MULTILINE)
    has = set(flags[1].split()) if flags else set()
    return next((name for name, needed in _LEVELS.items() if needed <= has), None)


def variables() -> dict:
    """Variables that keep compiler and linear algebra to the level of this processor; none where it has none."""
    if platform.machine() != "x86_64" or not _CPU_INFO.exists():
        return {}
    found = level(_CPU_INFO.read_text())
    # the linear algebra chooses by processor as well; one choice runs on both levels
    own = {"NUMBA_CPU_NAME": found, "NUMBA_CPU_FEATURES": "", "OPENBLAS_CORETYPE": "Haswell"}
    return own if found else {}
