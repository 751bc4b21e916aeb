"""The tension of a standing vehicle's tracks: that which they were laid with, however many links they have."""

import numpy as np
import pytest
from trackvib_sim.rui.sweeps.kinematics import update_motion
from trackvib_sim.vehicle.system import new_work
from trackvib_sim.vehicle.tracks.nodes import NodeWorkOffset
from trackvib_sim.vehicle.tracks.tracks import add_tracks

from .momentum import shoes
from .other_links import LINKS, with_links

pytestmark = pytest.mark.property

PHASES = (0.0, 0.25, 0.5, 0.75)
RIGHT = 1


@pytest.fixture(scope="module")
def mean_tension(vehicle, simulation, level_road):
    """A function of links, pitch and teeth: mean tension [N] of right tracks laid at several phases, and settled."""

    def measure(links, pitch, teeth):
        means = []
        for phase in PHASES:
            standing = simulation(speed=0.0, phase=phase, vehicle=with_links(vehicle, links, pitch, teeth))
            system, state, work = standing.system, standing.state, new_work(standing.system)
            update_motion(system.tree, state.tree, work.motion)
            add_tracks(
                system.tracks,
                state.tracks,
                state.tree,
                level_road,
                state.drive.path,
                work.motion,
                work.cuts,
                work.tracks,
                system.dt,
                False,
            )
            tension = shoes(system.tracks.chain, work.tracks.nodes)[-1, NodeWorkOffset.TENSION]
            assert tension.shape == (links,) and tension.min() > 0.0
            means.append(tension.mean())
        return np.mean(means)

    return measure


@pytest.mark.slow(reason="lets vehicles of many tracks come to rest")
def test_tension_is_the_pretension_whatever_the_links(vehicle, mean_tension):
    """Tracks of the same length from 100, 120 and 150 links have the same tension, near the pretension.

    The upper run sags and the hull sinks after the tracks were laid, which makes 6 to 11 %. Where on the wheels the
    pins come to stand changes the perimeter and so the tension by 2 %; the mean over four phases is taken.
    """
    tension = np.array([mean_tension(*links) for links in LINKS])
    assert np.abs(tension / vehicle.tracks.pretension[RIGHT] - 1.0).max() < 0.15
    assert np.ptp(tension) < 0.05 * tension.mean()
