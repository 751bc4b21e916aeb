"""The rules of the semi-active laws against what their sources say, on given motions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.laws.acceleration_driven import AccelerationDriven, MixedSkyhookAdd
from mr_mount_controller.laws.estimator import Motion
from mr_mount_controller.laws.hybrid import ContinuousSkyhook, Groundhook, Hybrid
from mr_mount_controller.laws.semi_active import DampingLaw
from mr_mount_controller.laws.skyhook import Skyhook
from mr_mount_controller.mount import PUBLISHED

PERIOD = 1e-3
SPEED = st.floats(-1.0, 1.0)
ACCELERATION = st.floats(-50.0, 50.0)
MOTIONS = st.builds(Motion, ACCELERATION, SPEED, ACCELERATION, SPEED)


class Wants(DampingLaw):
    """Wants what another law wants, of a given motion."""

    wanted = 0.0

    def damping_for(self, motion):
        return self.wanted


def damping_got(sample, wanted):
    """The damping of the current with which a law answers that wants a damping."""
    law = Wants(PERIOD)
    law.wanted = wanted
    return PUBLISHED.damping(law.update(sample(PERIOD)))


@pytest.mark.analytic
@given(motion=MOTIONS)
def test_continuous_skyhook_gives_the_force_of_a_skyhook(sample, motion):
    """Where a mount between soft and firm can, its force is c_sky v_p; elsewhere it has the nearest damping."""
    law = ContinuousSkyhook(PERIOD)
    across = motion.relative_velocity
    ideal = law.hook_damping * motion.velocity
    softest, firmest = PUBLISHED.damping(law.soft_current), PUBLISHED.damping(law.firm_current)
    force = damping_got(sample, law.damping_for(motion)) * across
    low, high = sorted((softest * across, firmest * across))
    # 1 N s/m is the table's error
    assert force == pytest.approx(min(max(ideal, low), high), abs=abs(across) * 1.0 + 1e-9)


@pytest.mark.analytic
@given(motion=MOTIONS)
def test_groundhook_gives_the_force_of_a_groundhook(sample, motion):
    """The mount pushes the hull with c v against v_c, or as near to it as a damper across the mounts can."""
    law = Groundhook(PERIOD)
    across = motion.relative_velocity
    ideal = -law.hook_damping * motion.base_velocity  # on the hull; the mount pushes it with c times `across`
    low, high = sorted((PUBLISHED.damping(law.soft_current) * across, PUBLISHED.damping(law.firm_current) * across))
    force = damping_got(sample, law.damping_for(motion)) * across
    assert force == pytest.approx(min(max(ideal, low), high), abs=abs(across) * 1.0 + 1e-9)


@pytest.mark.property
@given(motion=MOTIONS, share=st.floats(0.0, 1.0))
def test_hybrid_is_the_mean_of_both(motion, share):
    """The hybrid wants its share of what each of the two wants."""
    sky, ground = (law(PERIOD).damping_for(motion) for law in (ContinuousSkyhook, Groundhook))
    wanted = Hybrid(PERIOD, skyhook_share=share).damping_for(motion)
    assert wanted == pytest.approx(share * sky + (1.0 - share) * ground, rel=1e-9)


@pytest.mark.analytic
@given(motion=MOTIONS)
def test_acceleration_driven_switches_as_savaresi_says(motion):
    """Firm where z'' (z' - z_t') > 0."""
    assert AccelerationDriven(PERIOD).is_firm(motion) == (motion.acceleration * motion.relative_velocity > 0.0)


@pytest.mark.analytic
@pytest.mark.parametrize("phase", np.linspace(0.1, 6.2, 15))
def test_acceleration_driven_leads_skyhook_by_a_quarter(phase):
    """In a harmonic motion over a base at rest skyhook is always firm, ADD half of the time: z'' leads z' by 90 deg."""
    motion = Motion(-np.sin(phase), np.cos(phase), 0.0, 0.0)
    assert Skyhook(PERIOD).is_firm(motion)
    assert AccelerationDriven(PERIOD).is_firm(motion) == (np.sin(2.0 * phase) < 0.0)


@pytest.mark.analytic
@given(motion=MOTIONS, crossover=st.floats(0.1, 200.0))
def test_mixed_law_decides_as_savaresi_and_spelta_say(motion, crossover):
    """Skyhook's rule where z''^2 - w^2 z'^2 <= 0, that of ADD elsewhere."""
    slow = motion.acceleration**2 - (2.0 * np.pi * crossover * motion.velocity) ** 2
    rule = Skyhook if slow <= 0.0 else AccelerationDriven
    # squares of tiny numbers underflow, and rounding decides on the very border
    if abs(slow) > 1e-9 * motion.acceleration**2 > 1e-200:
        assert MixedSkyhookAdd(PERIOD, crossover=crossover).is_firm(motion) == rule(PERIOD).is_firm(motion)
