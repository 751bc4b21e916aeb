"""Runs of seconds over rough road: converged in the step, at the wanted speed, in their lane."""

import numpy as np
import pytest
from trackvib_sim.analysis.settling import settling_time
from trackvib_sim.analysis.vibration import band_limited, rms
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.vehicle.step_size import recommended_rate

pytestmark = [pytest.mark.property, pytest.mark.slow(reason="drives for many seconds")]

MEASURING = 8.0  # s; in less, the chance of chaotic blows changes an RMS by as much as the bound
ROUGH_FROM = 12.0  # m


@pytest.fixture(scope="module")
def run(simulation):
    """A function that drives on class E with the engine at rated speed.

    Returns the simulation, the settled part of the specific forces within the band (k, 2, 3), and of the speed (k,).
    """

    def do(speed, phase, physics=10_000):
        moving = simulation(speed, 1650.0, physics, phase=phase)
        settled = round(1000 * settling_time(speed, ROUGH_FROM))
        record = run_open_loop(moving, Iso8608Road("E", 1, 4.0, 8.0), settled + round(1000 * MEASURING))
        return moving, band_limited(record.specific_force, 1000.0)[settled:], record.speed[settled:]

    return do


@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0])
def test_result_has_converged_in_the_step(run, vehicle, speed):
    """Half the physics step that is recommended changes no RMS by 5 % or more.

    Four drives count as one: of a single one rounding alone, which is another on each processor, changes it by 4 %.
    """
    rate = recommended_rate(vehicle)
    coarse, fine = (
        rms(np.concatenate([run(speed, phase, physics)[1] for phase in (0.1, 0.35, 0.6, 0.85)]))
        for physics in (rate, 2 * rate)
    )
    assert coarse.min() > 0.1
    assert np.abs(fine / coarse - 1.0).max() < 0.05, (coarse, fine)


@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0])
def test_vehicle_keeps_speed_and_lane(run, speed):
    """On class E the driver keeps the mean speed to 0.2 %, on which the link-passing frequency rests, and the lane."""
    moving, _, speeds = run(speed, 0.35)
    assert speeds.mean() == pytest.approx(speed, rel=2e-3)
    assert abs(moving.state.tree.position[0, 1]) < 0.2


@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0])
def test_a_tooth_turns_for_each_pitch_of_road(simulation, vehicle, speed):
    """The sprockets mesh and the tracks lie fast: in 3 s of class E as many teeth turn as pitches of road go by.

    To 1 %: the road's length is that along its slopes, and the hull swings on its tracks by part of a pitch.
    """
    moving = simulation(speed, 1650.0, phase=0.35)
    sprockets = moving.system.tracks.sprockets
    before = moving.state.tree.hinge[sprockets.row]
    run_open_loop(moving, Iso8608Road("E", 1, 4.0, 8.0), 3000)
    teeth = (moving.state.tree.hinge[sprockets.row] - before) * sprockets.teeth / (2.0 * np.pi)
    assert moving.distance == pytest.approx(3.0 * speed, rel=0.02)
    np.testing.assert_allclose(teeth, moving.distance / vehicle.tracks.pitch, rtol=0.01)
