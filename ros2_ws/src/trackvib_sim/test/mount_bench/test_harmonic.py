"""A mount on the bench beside closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.mount_bench.harmonic import loop_numbers, shake
from trackvib_sim.vehicle.mount_law import mount_characteristics

LIMIT = 2e3  # N
CURRENTS = st.floats(0.0, 4.0)


@pytest.fixture(scope="module")
def yielding(system):
    """The shipped mounts with a yield force."""
    return system.mounts._replace(yield_fit=np.array([(0.0, 0.0, 0.0, LIMIT)] * 2))


@pytest.mark.analytic
@given(current=CURRENTS, amplitude=st.floats(1e-5, 5e-3), frequency=st.floats(0.1, 100.0))
def test_without_yield_a_loop_is_the_fits(system, current, amplitude, frequency):
    """Stiffness and damping that are read off a loop are k(I) and c(I)."""
    numbers = loop_numbers(shake(system.mounts, 0, current, amplitude, frequency))
    k, c = mount_characteristics(system.mounts, 0, current)
    assert numbers.stiffness == pytest.approx(k, rel=1e-9)
    assert numbers.damping == pytest.approx(c, rel=1e-9)
    assert numbers.heat == pytest.approx(np.pi * c * 2.0 * np.pi * frequency * amplitude**2, rel=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("current", [1.0, 3.0])
def test_far_beyond_yield_a_loop_is_that_of_friction(yielding, current):
    """Slowly and widely shaken the field takes 4 F_y A a cycle, less what the way back takes to build F_y up."""
    amplitude, frequency = 0.05, 1e-3
    (rubber, _), (k, c) = (mount_characteristics(yielding, 0, each) for each in (0.0, current))
    loop = shake(yielding, 0, current, amplitude, frequency)
    # each way from -F_y back to zero along a straight line, then exponentially towards F_y
    of_field = 4.0 * LIMIT * amplitude - 5.0 * LIMIT**2 / (k - rubber)
    of_damping = 2.0 * np.pi**2 * c * frequency * amplitude**2
    assert loop_numbers(loop).heat == pytest.approx(of_field + of_damping, rel=2e-3)
    assert loop.force.max() == pytest.approx(rubber * amplitude + LIMIT, rel=1e-3)


@pytest.mark.property
@given(current=CURRENTS, amplitude=st.floats(1e-5, 2e-2), frequency=st.floats(0.1, 50.0))
def test_yield_only_softens(system, yielding, current, amplitude, frequency):
    """A mount that yields is never stiffer than one that does not, and takes at least as much energy."""
    hard, soft = (loop_numbers(shake(mounts, 0, current, amplitude, frequency)) for mounts in (system.mounts, yielding))
    assert soft.stiffness <= hard.stiffness * (1.0 + 1e-9)
    assert soft.heat >= hard.heat * (1.0 - 1e-9)
