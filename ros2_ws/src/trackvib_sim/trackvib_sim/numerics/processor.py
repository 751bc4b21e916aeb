"""What kernels are compiled for: a level of x86-64, not the very processor, so that all of a level give the same bits.

Wider vectors add in another order, and the impacts of the tracks amplify what that rounds differently.
"""

import os
import platform
import re
from pathlib import Path

# Names of the compiler, and what /proc/cpuinfo calls that which a level has beyond those below it.
_V3 = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"}
_LEVELS = {"x86-64-v4": _V3 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}, "x86-64-v3": _V3}
_CPU_INFO = Path("/proc/cpuinfo")


def level_of(cpu_info: str):
    """Return the highest level that a processor has by the text of its /proc/cpuinfo; None below the third."""
    flags = re.search(r"^flags\s*:(.*)$", cpu_info, re.MULTILINE)
    has = set(flags[1].split()) if flags else set()
    return next((name for name, needed in _LEVELS.items() if needed <= has), None)


def target():
    """Return the name of what kernels are compiled for; None for the very processor, where that has no level.

    NUMBA_CPU_NAME, which numba knows, has precedence.
    """
    if chosen := os.environ.get("NUMBA_CPU_NAME"):
        return chosen
    if platform.machine() != "x86_64" or not _CPU_INFO.exists():
        return None
    return level_of(_CPU_INFO.read_text())
