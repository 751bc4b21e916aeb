"""The standing vehicle on its tracks: what the ground carries, and that it rests."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.road.store import Road
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.vehicle.body_tree import GRAVITY
from trackvib_sim.vehicle.equilibrium import static_equilibrium
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeOffset, NodeWorkOffset
from trackvib_sim.vehicle.tracks.tracks import add_tracks, new_track_work

RESTING = 16_000  # periods; to and fro on its tracks the vehicle swings with hardly any damping


@pytest.fixture(scope="module")
def stood(simulation, level):
    """The vehicle, standing for some seconds with its engine off, and what its sensors felt meanwhile."""
    standing = simulation(speed=0.0)
    return standing, run_open_loop(standing, level, RESTING)


@pytest.fixture(scope="module")
def standing_loads(stood, moved, added):
    """Forces (2, links, 3) of the ground on the nodes, their places, and what the tracks put on the bodies."""
    standing, _ = stood
    system, state = standing.system, standing.state
    cuts, work = new_cuts(system.tree), new_track_work(system.tracks, kept=2)
    road = Road(-400, 0.05, np.zeros((2, 801)))
    motion, path = moved(system.tree, state.tree), state.drive.path
    add_tracks(system.tracks, state.tracks, state.tree, road, path, motion, cuts, work, 0.0, True)

    def vectors(cells, first):
        by_quantity = cells.reshape(2, -1, STRIDE)[:, first : first + 3, 1 : system.tracks.chain.links[0] + 1]
        return np.moveaxis(by_quantity, 1, 2)

    return vectors(work.nodes, NodeWorkOffset.GROUND), vectors(state.tracks.nodes, NodeOffset.PLACE), added(cuts)


@pytest.mark.analytic
def test_ground_carries_the_weight_of_all(vehicle, table, standing_loads):
    """The ground's forces on the shoes push, balance, and add up to the weight of bodies and shoes, left as right."""
    ground, _, _ = standing_loads
    t = vehicle.tracks
    weight = (sum(body.mass for body in table) + sum(t.links) * t.shoe_mass) * GRAVITY
    assert ground[..., 2].min() == 0.0
    assert ground[..., 2].sum() == pytest.approx(weight, rel=1e-3)
    assert_allclose(ground[0, :, 2].sum(), ground[1, :, 2].sum(), rtol=1e-3)
    assert_allclose(ground[..., :2].sum((0, 1)), 0.0, atol=1e-3 * weight)


@pytest.mark.analytic
def test_tracks_carry_the_bodies(table, standing_loads):
    """What the tracks put on wheels, rollers, idlers, sprockets and hull adds up to the weight of the bodies."""
    _, _, loads = standing_loads
    weight = sum(body.mass for body in table) * GRAVITY
    assert_allclose(loads.force.sum(0), (0.0, 0.0, weight), rtol=0, atol=1e-3 * weight)


@pytest.mark.analytic
def test_ground_balances_the_centre_of_mass(vehicle, table, stood, standing_loads, moved):
    """The ground's forces have the moment of the weight of all bodies and shoes about the global axes."""
    standing, _ = stood
    ground, place, _ = standing_loads
    motion = moved(standing.system.tree, standing.state.tree)
    row = standing.system.tree.row
    origin, turn = (
        columns(motion, MotionOffset.ORIGIN, 3)[row],
        columns(motion, MotionOffset.ROTATION, 9)[row].reshape(-1, 3, 3),
    )
    centre = origin + np.einsum("nij,nj->ni", turn, [body.centre for body in table])
    weight = np.array([[body.mass] for body in table]) * standing.system.tree.gravity
    shoes = ground + vehicle.tracks.shoe_mass * standing.system.tree.gravity
    moment = np.cross(centre, weight).sum(0) + np.cross(place, shoes).sum((0, 1))
    # of 5e5 N with levers of metres
    assert_allclose(moment, 0.0, atol=500.0)


@pytest.mark.cross_engine
def test_tracks_as_springs_stand_as_tracks_do(stood):
    """The static equilibrium, with springs for tracks, has the hull and its arms where the whole vehicle has them.

    To 1 cm of height, 2 mrad of pitch and 2 cm of wheel travel: links hand on some load from wheel to wheel.
    """
    standing, _ = stood
    found, simple = standing.state.tree, static_equilibrium(standing.system, 1.0).tree
    assert found.position[0, 2] == pytest.approx(simple.position[0, 2], abs=0.01)
    assert found.attitude[0, 2] == pytest.approx(simple.attitude[0, 2], abs=0.001)
    suspension = standing.system.suspension
    assert_allclose(found.hinge[suspension.row], simple.hinge[suspension.row], rtol=0, atol=0.02 / suspension.reach)


@pytest.mark.property
def test_standing_vehicle_rests(stood, level):
    """From the start the sensors feel gravity to 2 %, after some seconds to 0.1 % and the vehicle keeps its place."""
    standing, settling = stood
    assert_allclose(np.linalg.norm(settling.specific_force, axis=2), GRAVITY, rtol=0.02)
    before = standing.state.tree.position.copy()
    resting = run_open_loop(standing, level, 1000)
    assert_allclose(np.linalg.norm(resting.specific_force, axis=2), GRAVITY, rtol=1e-3)
    assert_allclose(standing.state.tree.position, before, rtol=0, atol=1e-3)
    assert np.abs(resting.speed).max() < 1e-3
