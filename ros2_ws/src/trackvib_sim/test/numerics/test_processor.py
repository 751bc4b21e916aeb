"""What kernels are compiled for: a level of x86-64, by what the processor has."""

import numba
import pytest
from trackvib_sim.numerics import compiled  # noqa: F401  which chooses
from trackvib_sim.numerics.processor import level_of, target

V3 = "fpu sse4_2 avx avx2 bmi1 bmi2 f16c fma abm movbe"
V4 = f"{V3} avx512f avx512bw avx512cd avx512dq avx512vl"

pytestmark = pytest.mark.analytic


@pytest.mark.parametrize(
    ("flags", "level"),
    [
        (V4, "x86-64-v4"),
        (f"{V4} avx512_fp16 amx_tile", "x86-64-v4"),
        (V4.replace(" avx512vl", ""), "x86-64-v3"),
        (V3, "x86-64-v3"),
        (V3.replace(" movbe", ""), None),
        ("", None),
    ],
)
def test_level_is_the_highest_that_is_whole(flags, level):
    """One missing instruction set makes it the level below."""
    assert level_of(["processor\t: 0\n", "model name\t: avx512f\n", f"flags\t\t: {flags}\n", "bugs\t\t:\n"]) == level


def test_no_flags_no_level():
    """Other processors have none."""
    assert level_of(["processor\t: 0\n", "Features\t: fp asimd\n"]) is None


def test_kernels_are_compiled_for_it():
    """By the real compiler."""
    _, name, _ = numba.core.registry.cpu_target.target_context.codegen().magic_tuple()
    assert target() in (name, None)
