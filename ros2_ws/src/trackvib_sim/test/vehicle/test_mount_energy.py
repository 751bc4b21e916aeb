"""The mounts' energy account: of motions with closed forms, of any current, of whole runs under switching current."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mr_mount_controller.laws.base import ControlLaw
from mr_mount_controller.laws.skyhook import Skyhook
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.rui.sweeps.tree import rest_lanes
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.vehicle.mount_energy import (
    mount_energy_account,
    new_mount_energy_state,
    start_mount_energy,
    update_mount_energy,
)
from trackvib_sim.vehicle.mount_law import lay_fields, mount_characteristics, new_field_state

from .generated_vehicles import yielding

DT = 1e-4  # s
CLOSED = 1e-3  # largest residual, of the greatest part
AMPLITUDE, FREQUENCY = 1e-3, 20.0  # rad, Hz, of the powertrain on its hinge
CYCLE = round(1.0 / FREQUENCY / DT)  # steps


@pytest.fixture(scope="module")
def swung(system, moved):
    """A function of currents, one a step, that books a swinging powertrain on a hull at rest; yields the account.

    It begins at its greatest angle. Speeds are those of the middle of the steps, as in a run.
    """

    def swing(currents):
        state, audit, body, w = (
            rest_lanes(system.tree),
            new_mount_energy_state(2),
            system.mounts.body[0],
            2.0 * np.pi * FREQUENCY,
        )
        fields = new_field_state(2)
        lay_fields(system.mounts, np.full(2, float(currents[0])), fields)
        for step, current in enumerate(currents):
            time = (step - 1) * DT
            state.hinge[body] = AMPLITUDE * np.cos(w * time)
            state.hinge_rate[body] = -w * AMPLITUDE * np.sin(w * (time - 0.5 * DT))
            motion = moved(system.tree, state)
            update_mount_energy(system.mounts, fields, motion, np.full(2, float(current)), 0.0, 0.0, DT, audit)
            if step == 0:
                start_mount_energy(audit)
            yield mount_energy_account(audit)

    return swing


@pytest.fixture(scope="module")
def arms(system):
    """Sum over both mounts of the squared arms about the hinge, weighted as stiffness and as damping are [m^2]."""
    x, _, z = system.mounts.upper[0]
    return [2.0 * (x * x + ratio[0] * z * z) for ratio in (system.mounts.stiffness[0], system.mounts.damping[0])]


@pytest.mark.analytic
@pytest.mark.parametrize("current", [0.8, 3.0])
def test_a_harmonic_cycle_takes_pi_c_w_a_squared(system, swung, arms, current):
    """Under constant current the work of whole cycles is all heat, to the change of the arms with the angle."""
    *_, found = swung([current] * (4 * CYCLE + 1))
    _, c = mount_characteristics(system.mounts, 0, current)
    expected = 4.0 * np.pi * c * arms[1] * 2.0 * np.pi * FREQUENCY * AMPLITUDE**2
    assert found.dissipated == pytest.approx(expected, rel=1e-3)
    assert found.work == pytest.approx(expected, rel=1e-3)
    assert abs(found.exchanged) < 1e-9 and abs(found.stored) < 1e-3 * expected
    assert found.error < CLOSED


@pytest.mark.analytic
def test_switching_at_the_greatest_deflection_gives_the_springs_energy_away(system, swung, arms):
    """Soft at rest points and firm in the middle: twice a cycle (k2 - k1) times half the squared deflection is gone.

    The deflection at the turning points includes the static one, against which the preload works.
    """
    soft, firm = 0.8, 3.0
    quarter = np.repeat([soft, firm, soft, firm], CYCLE // 4)
    *_, found = swung(np.concatenate((quarter, quarter, [soft] * 2)))
    k = [mount_characteristics(system.mounts, 0, current)[0] for current in (soft, firm)]
    given = 4.0 * 0.5 * (k[1] - k[0]) * arms[0] * AMPLITUDE**2
    assert found.exchanged == pytest.approx(given, rel=0.02)
    assert found.error < CLOSED


@pytest.mark.property
@settings(max_examples=20)
@given(currents=st.lists(st.floats(-1.0, 6.0), min_size=2, max_size=20))
def test_a_mount_is_passive_under_any_current(swung, currents):
    """Whatever the current does, heat never falls, and what a mount gives back it had stored or had from the field.

    A speed that changes its sign within a step can take a little less than nothing in that step, so heat is looked at
    over intervals of 3 ms.
    """
    account = list(swung(np.repeat(currents, 30)))
    dissipated = np.array([found.dissipated for found in account])
    assert (np.diff(dissipated[::30]) > 0.0).all()
    for found in account:
        assert found.work - found.exchanged - found.stored >= -CLOSED * max(map(abs, found))


class Random(ControlLaw):
    """Any current at any time, each mount its own, some beyond what driver and mounts can do."""

    def reset(self):
        """Begin the same sequence anew."""
        self._random = np.random.default_rng(1)
        self._current = np.ones(2)

    def update(self, sample):
        """Change every few milliseconds."""
        if self._random.random() < 0.2:
            self._current = self._random.uniform(-1.0, 6.0, 2)
        return self._current


@pytest.fixture(scope="module")
def rough():
    """A class E road that begins under the vehicle."""
    return Iso8608Road("E", 1, 4.0, 8.0)


QUICK = dict(model="current_loop", delay=0.001, eddy_time_constant=0.003, slew_rate=500.0)


@pytest.mark.property
@pytest.mark.parametrize("mounts", [lambda vehicle: vehicle, yielding], ids=["shipped", "yielding"])
@pytest.mark.parametrize(("law", "items"), [(Skyhook, {}), (Skyhook, QUICK), (Random, QUICK)])
def test_a_run_under_switching_current_closes(simulation, changed, rough, law, items, mounts):
    """Two seconds of class E at 10 m/s with the engine at rated speed: below 0.1 % is left over.

    Switching moves energy enough for that to say something, and the heat is that of the published power.
    """
    moving = simulation(10.0, 1650.0, vehicle=mounts(changed("coil", **items)))
    dissipation, advance = [], moving.advance

    def watched(demanded):
        advance(demanded)
        dissipation.append(moving.sample.mounts.dissipated_power.copy())

    moving.advance = watched
    run_closed_loop(moving, rough, law(1e-3), 2000)
    found = mount_energy_account(moving.state.mount_energy)
    assert found.error < CLOSED
    assert abs(found.exchanged) > 10.0 * CLOSED * found.work > 0.0
    assert np.min(dissipation) >= 0.0
    assert found.dissipated == pytest.approx(1e-3 * np.sum(dissipation), rel=0.05)


@pytest.mark.property
def test_work_of_the_imposed_displacement_is_in_the_account(simulation, level):
    """A standing vehicle whose engine shakes its mounts at 70 Hz: work and heat agree to 0.1 %."""
    moving = simulation(0.0, 2100.0, imposed=True)
    run_open_loop(moving, level, 1000)
    found = mount_energy_account(moving.state.mount_energy)
    assert found.work > 1.0 and abs(found.exchanged) < 1e-9
    assert found.error < CLOSED
