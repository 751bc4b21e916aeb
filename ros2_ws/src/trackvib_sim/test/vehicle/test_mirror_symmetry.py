"""Left and right: a mirrored vehicle on the mirrored road moves as the mirror image."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation import run_in
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.simulation import Probe
from trackvib_sim.vehicle.sensors import sensors_of
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeOffset

pytestmark = pytest.mark.property

LATERAL = (NodeOffset.PLACE + 1, NodeOffset.VELOCITY + 1, NodeOffset.SHEAR + 1)


class Mirrored:
    """A road with its sides swapped."""

    def __init__(self, road):
        self._road, self.spacing = road, road.spacing

    def heights(self, first, count):
        """Return the heights, right before left."""
        return self._road.heights(first, count)[::-1]


@pytest.fixture(scope="module")
def partner(rows):
    """Row of each row's body on the other side of the vehicle; bodies in the middle are their own."""
    swap = np.arange(max(rows.values()) + 1)
    for left, right in ((name, name.replace("left", "right")) for name in rows if name.startswith("left_")):
        swap[[rows[left], rows[right]]] = rows[right], rows[left]
    return swap


def mirror(state, partner, turret):
    """Turn a state in place into its mirror image about the plane y = 0."""
    tree, tracks = state.tree, state.tracks
    state.drive.path.offset[0] *= -1.0
    state.drive.driving.turn_integral[0] *= -1.0
    tree.position[0] *= (1, -1, 1)
    tree.velocity[0] *= (1, -1, 1)
    tree.attitude[0] *= (1, -1, 1, -1)
    tree.angular_velocity[0] *= (-1, 1, -1)
    for values in (tree.hinge, tree.hinge_rate):
        values[: len(partner)] = values[partner]
        values[turret] *= -1
    sign = np.ones((NodeOffset.SIZE, 1))
    sign[list(LATERAL)] = -1
    tracks.nodes[:] = (tracks.nodes.reshape(2, NodeOffset.SIZE, STRIDE)[::-1] * sign).reshape(tracks.nodes.shape)
    for values in (tracks.link, tracks.outermost, tracks.passed, *tracks.tensioner, *state.coils):
        values[:] = values[::-1].copy()


@pytest.mark.slow(reason="drives twice")
def test_mirror_image_moves_as_the_mirror_image(vehicle, simulation, partner, rows):
    """From a state in the middle of a run on an uneven road, with the engine off: each force has its mirror image.

    Rounding alone parts both, 1e-16 m of 2e8 N/m springs on 16 kg; contacts that come and go amplify it.
    """
    road = Iso8608Road("E", 1, 0.0, 4.0)
    points = [Probe(sensor.body, sensor.place) for sensor in sensors_of(vehicle)]  # sensors remember what was before
    one, other = (simulation(10.0, phase=0.3, probes=points) for _ in range(2))
    for each in (one, other):
        run_open_loop(each, road, 500)
    mirror(other.state, partner, rows["turret"])
    assert np.abs(other.state.tracks.nodes - one.state.tracks.nodes).max() > 1.0
    other.road = type(other.road)()
    found, image = run_open_loop(one, road, 300), run_open_loop(other, Mirrored(road), 300)
    assert_allclose(image.probed, found.probed * (1, -1, 1), rtol=0, atol=1e-6)
    assert_allclose(image.speed, found.speed, rtol=0, atol=1e-9)
    assert np.abs(found.probed[:, :, 1]).max() > 0.1


def test_tracks_in_phase_on_an_even_road_keep_the_vehicle_straight(easy_teeth, simulation, level, monkeypatch):
    """Where left and right are alike nothing pushes sideways but what rounding leaves.

    With teeth that pins enter freely, and soon after the tracks are laid: impacts amplify rounding, from 1e-11 m/s^2
    here to up to 0.1 m/s^2 within the run-in of a run.
    """
    monkeypatch.setattr(run_in, "DURATION", 0.3)
    found = run_open_loop(simulation(10.0, phase=0.0, vehicle=easy_teeth), level, 200)
    assert np.abs(found.specific_force[:, :, 1]).max() < 1e-6
    assert np.ptp(found.specific_force[:, :, 2], axis=0).min() > 0.1
