"""Mounts: the paper's fits and what is below them, and the force pair between hull and powertrain."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset, rotation
from trackvib_sim.rui.sweeps.tree import rest_lanes, to_lanes
from trackvib_sim.vehicle.body_tree import GRAVITY
from trackvib_sim.vehicle.coil import CoilState
from trackvib_sim.vehicle.mount_law import (
    lay_fields,
    mount_characteristics,
    mount_force,
    mount_stored_energy,
    new_field_state,
)
from trackvib_sim.vehicle.mounts import add_mounts, mount_deflection, new_mount_sample, observe_mounts

CURRENTS = st.floats(-1e3, 1e3)
METRES = st.tuples(*[st.floats(-0.1, 0.1)] * 3)
SPEEDS = st.tuples(*[st.floats(-10.0, 10.0)] * 3)
SEEDS = st.integers(0, 2**32 - 1)
FEW = settings(max_examples=30)


def laid(mounts, currents):
    """The fields of mounts that were at ease when these currents came."""
    fields = new_field_state(len(mounts.body))
    lay_fields(mounts, np.broadcast_to(np.asarray(currents, dtype=float), mounts.coils), fields)
    return fields


@pytest.mark.literature
@pytest.mark.parametrize(
    ("current", "stiffness", "ratio", "damping"),
    [(1.0, 3.196e6, 0.1507, 1.704e4), (2.0, 4.573e6, 0.4179, 5.652e4), (3.0, 5.283e6, 0.5169, 7.514e4)],
)
def test_fits_give_the_printed_values(system, current, stiffness, ratio, damping):
    """k, zeta and c at 1, 2 and 3 A are the printed ones to their four digits."""
    k, c = mount_characteristics(system.mounts, 0, current)
    assert k == pytest.approx(stiffness, abs=0.5e3)
    assert c == pytest.approx(damping, abs=5.0)
    assert c / (2.0 * np.sqrt(k * system.mounts.carried_mass[0])) == pytest.approx(ratio, abs=0.5e-4)


@pytest.mark.literature
def test_natural_frequency_is_the_papers(system):
    """Where a mount has the paper's 3 kN/mm, it carries its mass at the paper's 8.7 Hz."""
    m = system.mounts
    current = brentq(lambda i: mount_characteristics(m, 0, i)[0] - 3e6, 0.7, m.highest[0])
    k, _ = mount_characteristics(m, 0, current)
    assert np.sqrt(k / m.carried_mass[0]) / (2.0 * np.pi) == pytest.approx(8.7, abs=0.05)
    assert current == pytest.approx(0.894, abs=0.5e-3)


@pytest.mark.literature
def test_mounts_are_trimmed_for_about_the_rated_load(vehicle, system):
    """Nobody gives their loads: what they carry turns the powertrain as its weight does, 9.8 kN each to a tenth."""
    m, body = system.mounts, vehicle.powertrain
    moments = [np.cross(mount.place, load)[1] for mount, load in zip(vehicle.mounts.values(), m.load, strict=True)]
    assert sum(moments) == pytest.approx(-body.mass * GRAVITY * body.centre[0])
    assert_allclose(m.load[:, 2], 9800.0, rtol=0.1)


@pytest.mark.property
@given(current=CURRENTS)
def test_current_is_clamped(system, current):
    """Beyond the fits' range a mount is as at its end, below zero as without a current."""
    m = system.mounts
    clamped = min(max(current, 0.0), m.highest[0])
    assert mount_characteristics(m, 0, current) == mount_characteristics(m, 0, clamped)


@pytest.mark.literature
def test_a_dead_coil_leaves_the_rubber(system):
    """Without a current the fit's 0.904 kN/mm is left, with the damping ratio of the rubber."""
    m = system.mounts
    k, c = mount_characteristics(m, 0, 0.0)
    assert k == pytest.approx(0.904e6) == m.rubber[0]
    assert c == pytest.approx(2.0 * m.rubber_damping_ratio[0] * np.sqrt(k * m.carried_mass[0]))
    # where the paper's zeta(I) is negative
    assert mount_characteristics(m, 0, 0.640)[1] == pytest.approx(c * np.sqrt(mount_characteristics(m, 0, 0.64)[0] / k))


@pytest.mark.property
@given(current=CURRENTS, l=METRES, l_d=SPEEDS)
def test_damping_never_drives(system, current, l, l_d):
    """Whatever range the file allows, damping is never negative and takes power from every motion."""
    wide = system.mounts._replace(highest=np.full(2, 6.0))
    for mounts in (system.mounts, wide):
        k, c = mount_characteristics(mounts, 0, current)
        assert k > 0.0 and c >= 0.0
        fields = laid(mounts, current)
        force, power = mount_force(mounts, fields, 0, current, l, l_d)
        still, _ = mount_force(mounts, fields, 0, current, l, (0.0, 0.0, 0.0))
        taken = -np.dot(np.subtract(force, still), l_d)
        assert power >= 0.0
        # differences of forces up to 1e6 N
        assert taken == pytest.approx(power, rel=1e-9, abs=1e-7)


@pytest.mark.analytic
def test_force_law_by_axis(system):
    """Each axis has its ratio of k and c; what the mount carries at rest comes on top."""
    m, l, l_d = system.mounts, (0.001, -0.002, 0.003), (0.1, 0.2, -0.3)
    k, c = mount_characteristics(m, 0, 1.5)
    expected = -k * m.stiffness[0] * l - c * m.damping[0] * l_d + m.load[0]
    assert_allclose(mount_force(m, laid(m, 1.5), 0, 1.5, l, l_d)[0], expected, rtol=1e-13)


@pytest.mark.analytic
@given(current=CURRENTS, l=METRES)
def test_elastic_force_is_the_slope_of_the_stored_energy(system, current, l):
    """At rest a mount pushes down the slope of its energy, which is zero at the unloaded place."""
    m, h = system.mounts, 1e-3
    fields = laid(m, current)
    slope = [
        (mount_stored_energy(m, fields, 0, tuple(l + step)) - mount_stored_energy(m, fields, 0, tuple(l - step)))
        / (2.0 * h)
        for step in h * np.eye(3)
    ]
    force, _ = mount_force(m, fields, 0, current, l, (0.0, 0.0, 0.0))
    # central differences are exact in a parabola; rounding of energies up to 1e5 J over 2 mm
    assert_allclose(force, np.negative(slope), rtol=0, atol=1e-6)
    assert mount_stored_energy(m, fields, 0, (0.0, 0.0, 0.0)) == 0.0


@pytest.mark.analytic
@FEW
@given(seed=SEEDS, index=st.integers(0, 1))
def test_deflection_rate_is_the_rate_of_deflection(system, random_state, moved, seed, index, drifted):
    """l_d is the time derivative of l along any moving state."""
    state, h = to_lanes(system.tree, random_state(seed)), 1e-5
    _, _, l_d = mount_deflection(system.mounts, moved(system.tree, state), index, 0.0, 0.0)
    before, after = (
        np.array(mount_deflection(system.mounts, moved(system.tree, drifted(state, t)), index, 0.0, 0.0)[1])
        for t in (-h, h)
    )
    # central difference as in the places: h^2 of the third derivative, 1e-15 / h of rounding
    assert_allclose((after - before) / (2.0 * h), l_d, rtol=0, atol=1e-8)


@pytest.mark.property
@FEW
@given(seed=SEEDS, left=st.floats(0.0, 5.0), right=st.floats(0.0, 5.0))
def test_force_pair_leaves_total_momentum_alone(system, random_motion, added, seed, left, right):
    """Forces and moments on hull and powertrain cancel about any point, and act on nothing else."""
    motion, cuts = random_motion(seed), new_cuts(system.tree)
    add_mounts(system.mounts, laid(system.mounts, [left, right]), motion, cuts, np.array([left, right]), 1e-4, 0.02)
    loads = added(cuts)
    moment = loads.moment + np.cross(columns(motion, MotionOffset.ORIGIN, 3), loads.force)
    assert np.abs(loads.force).max() > 0.0
    assert_allclose(loads.force.sum(0), 0.0, atol=1e-12 * np.abs(loads.force).max())
    assert_allclose(moment.sum(0), 0.0, atol=1e-12 * np.abs(moment).max())
    touched = np.flatnonzero(np.abs(loads.force).sum(1))
    assert set(touched) == {system.mounts.parent[0], system.mounts.body[0]}
    assert not loads.torque.any()


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_force_pair_does_the_work_of_the_mounts(system, random_motion, added, seed):
    """The pair's power on both bodies is the sum of force times deflection rate of the two mounts."""
    m, currents = system.mounts, np.array([1.0, 2.0])
    motion, cuts = random_motion(seed), new_cuts(system.tree)
    add_mounts(m, laid(m, currents), motion, cuts, currents, 0.0, 0.0)
    loads, velocity, rate = (
        added(cuts),
        columns(motion, MotionOffset.VELOCITY, 3),
        columns(motion, MotionOffset.ANGULAR_VELOCITY, 3),
    )
    power = np.sum(loads.force * velocity) + np.sum(loads.moment * rate)
    expected = 0.0
    for index in range(2):
        _, l, l_d = mount_deflection(m, motion, index, 0.0, 0.0)
        expected += np.dot(mount_force(m, laid(m, currents), index, currents[index], l, l_d)[0], l_d)
    size = np.abs(loads.force).max() * np.abs(velocity).max() + np.abs(loads.moment).max()
    assert power == pytest.approx(expected, abs=1e-11 * size)


@pytest.mark.analytic
def test_imposed_displacement_acts_across_the_mounts(system, moved, added):
    """A displacement d imposed at a rate d' pushes each side as a deflection -d at a rate -d' would."""
    state = rest_lanes(system.tree)
    motion = moved(system.tree, state)
    k, c = mount_characteristics(system.mounts, 0, 1.0)
    loads = []
    for d, d_rate in ((0.0, 0.0), (2e-4, 0.05)):
        cuts = new_cuts(system.tree)
        add_mounts(system.mounts, laid(system.mounts, 1.0), motion, cuts, np.ones(2), d, d_rate)
        loads.append(added(cuts))
    push = (loads[1].force - loads[0].force)[[system.mounts.body[0], system.mounts.parent[0]], 2]
    assert_allclose(push, [2.0 * (k * 2e-4 + c * 0.05), -2.0 * (k * 2e-4 + c * 0.05)], rtol=1e-9)


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_observed_mounts_are_those_that_act(system, random_motion, added, seed):
    """What a sample says about the mounts is the force that acts on the powertrain, imposed displacement included.

    The field, not yet where the coils' currents will bring it, decides.
    """
    m, currents = system.mounts, np.array([0.9, 3.1])
    motion, cuts = random_motion(seed), new_cuts(system.tree)
    fields = laid(m, currents)
    add_mounts(m, fields, motion, cuts, currents, 2e-4, 0.05)
    sample, in_coils = new_mount_sample(m), np.array([1.0, 3.0])
    observe_mounts(m, fields, motion, CoilState(np.zeros((2, 0)), in_coils, in_coils, currents), 2e-4, 0.05, sample)
    turn = np.reshape(rotation(motion, m.parent[0]), (3, 3))
    assert_allclose(turn @ sample.force.sum(0), added(cuts).force[m.body[0]], rtol=1e-12)
    assert_allclose(sample.current, in_coils)
    for index in range(2):
        assert (sample.stiffness[index], sample.damping[index]) == mount_characteristics(m, index, currents[index])
        expected = sample.damping[index] * np.dot(m.damping[index], sample.velocity[index] ** 2)
        assert sample.dissipated_power[index] == pytest.approx(expected, rel=1e-12)
