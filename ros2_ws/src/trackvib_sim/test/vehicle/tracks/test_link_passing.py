"""The rolling vehicle: how a run begins, and the line that the links draw into every spectrum."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.analysis.vibration import psd, rms
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.simulation import CHASSIS, POWERTRAIN, Probe

from .other_links import LINKS, with_links

pytestmark = pytest.mark.slow(reason="rolls over seconds of track")

RATE = 1000.0  # Hz, of the samples
RESOLUTION = 1.0  # Hz


@pytest.mark.analytic
@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0])
@pytest.mark.parametrize(("links", "pitch", "teeth"), LINKS[:2])
def test_links_pass_at_their_frequency(easy_teeth, simulation, links, pitch, teeth, speed):
    """Where pins enter freely the strongest vertical line within 40 % of v / p lies at v / p, v the mean speed."""
    moving = simulation(speed=speed, vehicle=with_links(easy_teeth, links, pitch, teeth), phase=0.3)
    _assert_line_at_link_passing(moving, pitch)


@pytest.mark.literature
def test_shipped_vehicle_has_the_papers_line(vehicle, simulation):
    """[Tao2025]: at 10 m/s the main peak of chassis and powertrain lies at v / p = 86.9 Hz."""
    _assert_line_at_link_passing(simulation(speed=10.0, phase=0.3), vehicle.tracks.pitch)


def _assert_line_at_link_passing(moving, pitch):
    """To one bin of the spectra of both sensors on a smooth road, thirty times over what is between the lines."""
    run = run_open_loop(moving, Iso8608Road("A", 1, 4.0, 4.0), 5000)
    settled = slice(2000, None)
    passing = run.speed[settled].mean() / pitch
    for sensor in (CHASSIS, POWERTRAIN):
        frequency, density = psd(run.specific_force[settled, sensor], RATE, RESOLUTION)
        near = np.abs(frequency - passing) < 0.4 * passing
        strongest = density[near, 2].argmax()
        assert frequency[near][strongest] == pytest.approx(passing, abs=RESOLUTION)
        assert density[near, 2][strongest] > 30.0 * np.median(density[near, 2])


@pytest.mark.property
@pytest.mark.parametrize("speed", [5.0, 10.0, 20.0])
def test_run_begins_settled(vehicle, simulation, speed):
    """On a level road the first two seconds are as the next two: no jolt, and no more and no less vibration."""
    probes = (Probe("hull", tuple(vehicle.powertrain.place)), Probe("turret", (0.0, 0.0, 0.0)))
    moving = simulation(speed=speed, phase=0.5, probes=probes)
    run = run_open_loop(moving, Iso8608Road("A", 1, 1e6, 1.0), 4000)
    vibration = run.specific_force - run.specific_force.mean(axis=0)
    size = np.linalg.norm(vibration, axis=2)
    first, then = slice(None, 2000), slice(2000, None)
    assert rms(size[then]).min() > 0.1
    assert (size[first].max(axis=0) < 1.5 * size[then].max(axis=0)).all()
    assert_allclose(rms(size[first]), rms(size[then]), rtol=0.1)
    assert run.speed.mean() == pytest.approx(speed, rel=2e-3)


@pytest.mark.property
def test_standing_vehicle_stands(simulation):
    """With its engine off nothing moves but the last of the swinging of the upper runs, which dies out."""
    standing = simulation(speed=0.0)
    run = run_open_loop(standing, Iso8608Road("A", 1, 1e6, 1.0), 4000)
    vibration = run.specific_force - run.specific_force[3000:].mean(axis=0)
    assert np.abs(vibration).max() < 0.3
    assert np.abs(vibration[3000:]).max() < np.abs(vibration[:1000]).max()
    assert np.abs(run.speed).max() < 5e-3
