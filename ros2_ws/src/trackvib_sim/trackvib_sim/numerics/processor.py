"""What kernels are compiled for: a level of x86-64, not the very processor, so that all of a level give the same bits.

Wider vectors add in another order, and the impacts of the tracks amplify what that rounds differently.
"""

import os
import platform
from contextlib import suppress

# Names of the compiler, and what /proc/cpuinfo calls that which a level has beyond those below it.
_V3 = {"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"}
_LEVELS = {"x86-64-v4": _V3 | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}, "x86-64-v3": _V3}


def level_of(cpu_info):
    """Return the highest level that a processor has by the lines of its /proc/cpuinfo; None below the third."""
    flags = next((line for line in cpu_info if line.startswith("flags")), "")  # of the first of many cores
    has = set(flags.partition(":")[2].split())
    return next((name for name, needed in _LEVELS.items() if needed <= has), None)


def target():
    """Return the name of what kernels are compiled for; None for the very processor, where that has no level.

    NUMBA_CPU_NAME, which numba knows, has precedence.
    """
    if chosen := os.environ.get("NUMBA_CPU_NAME"):
        return chosen
    if platform.machine() == "x86_64":
        with suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as lines:
            return level_of(lines)
    return None
