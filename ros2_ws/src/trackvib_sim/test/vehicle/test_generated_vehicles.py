"""Vehicles of many kinds stand, close their tracks, and are their own mirror images."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.linalg import eigh
from trackvib_sim.rui.linear.model import LinearModel, Mount
from trackvib_sim.rui.linear.modes import modes
from trackvib_sim.rui.state import rest_state
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.vehicle.body_tree import GRAVITY, SIDES, bodies_on_hinges, build_body_table, mass_of_bodies
from trackvib_sim.vehicle.equilibrium import static_equilibrium
from trackvib_sim.vehicle.mount_law import mount_axes
from trackvib_sim.vehicle.mount_loads import loads_at_rest
from trackvib_sim.vehicle.mounts import mount_turn
from trackvib_sim.vehicle.sensors import sensors_of
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.supports import add_supports
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.tracks.layout import assemble_track

from .generated_vehicles import made, vehicles

pytestmark = [pytest.mark.property, pytest.mark.slow(reason="builds dozens of vehicles")]
FEW = settings(max_examples=15, suppress_health_check=[HealthCheck.too_slow])
MIRROR = np.array([1.0, -1.0, 1.0])


def standing(vehicle):
    """The record of a vehicle at rest with its engine off."""
    return build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)


@FEW
@given(vehicle=vehicles())
def test_its_mass_is_that_of_its_table(vehicle):
    """To the last bit: the masses are summed in the order of the table."""
    assert mass_of_bodies(vehicle) == sum(body.mass for body in build_body_table(vehicle))


@FEW
@given(vehicle=vehicles())
def test_it_stands_and_its_loads_are_the_weight(moved, added, vehicle):
    """In equilibrium all that acts on wheels and hull adds up to the weight, and every wheel is pushed up."""
    system = standing(vehicle)
    state, cuts = static_equilibrium(system, 1.0), new_cuts(system.tree)
    add_supports(system.supports, moved(system.tree, state.tree), cuts)
    loads = added(cuts)
    weight = sum(body.mass for body in build_body_table(vehicle)) * GRAVITY
    assert_allclose(loads.force.sum(0), (0.0, 0.0, weight), rtol=0, atol=1e-6 * weight)
    assert loads.force[system.supports.wheel, 2].min() > 0.0


@FEW
@given(vehicle=vehicles(), phase=st.floats(0.0, 1.0))
def test_tracks_close(vehicle, phase):
    """Every link of each side spans one pitch, that from the last pin to the first among them, and all the same."""
    travel = standing(vehicle).tracks.tensioner.fitted
    for side in SIDES:
        place, _ = assemble_track(vehicle, side, travel[side], phase)
        assert len(place) == vehicle.tracks.links[side]
        length = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1)
        assert_allclose(length, vehicle.tracks.pitch, rtol=0, atol=2e-5)
        assert np.ptp(length) < 1e-6


@FEW
@given(vehicle=vehicles())
def test_mounts_share_the_weight_of_what_they_carry(vehicle):
    """Trimmed mounts hold a body where it is drawn: their loads balance its weight and its moment."""
    loads, bodies = loads_at_rest(vehicle), bodies_on_hinges(vehicle)
    for name in {mount.body for mount in vehicle.mounts.values()}:
        body, held = bodies[name], {each: mount for each, mount in vehicle.mounts.items() if mount.body == name}
        force = {each: mount_turn(mount) @ loads[each] for each, mount in held.items()}
        weight = np.array([0.0, 0.0, -body.mass * GRAVITY])
        moment = sum(np.cross(mount.place, force[each]) for each, mount in held.items())
        assert_allclose(sum(force.values()), -weight, atol=1e-6 * body.mass * GRAVITY)
        assert_allclose(moment, -np.cross(body.centre, weight), atol=1e-6 * body.mass * GRAVITY)


@FEW
@given(vehicle=vehicles(cabin=None, coils=0))
def test_mirror_image_stands_as_the_mirror_image(vehicle):
    """With left and right places swapped the hull leans the other way, by as much."""
    arms = vehicle.swing_arms
    swapped = arms.model_copy(update={"wheel_x": arms.right_wheel_x, "right_wheel_x": arms.wheel_x})
    tracks = vehicle.tracks.model_copy(update={"links": vehicle.tracks.links[::-1]})
    other = vehicle.model_copy(update={"swing_arms": swapped, "tracks": tracks})
    one, image = (static_equilibrium(standing(each), 1.0).tree for each in (vehicle, other))
    # the tensioners' travel is found to 1e-9 m, on each side for itself
    assert_allclose(image.position[0], MIRROR * one.position[0], atol=1e-7)
    assert_allclose(image.attitude[0], one.attitude[0] * (1, -1, 1, -1), atol=1e-7)


@FEW
@given(mounts=st.integers(3, 8), coils=st.integers(0, 3))
def test_free_powertrain_has_the_six_frequencies_of_its_matrices(mounts, coils):
    """On a hull that is held, the modes are those of the 6 x 6 matrices of mass and stiffness about its origin."""
    vehicle = made(5, 0.0, 0, 0, True, False, mounts, coils, None)
    table, system = build_body_table(vehicle), standing(vehicle)
    pair = [body for body in table if body.name in ("hull", "powertrain")]
    powertrain, record = pair[1], system.mounts
    mass, stiffness = _mass(powertrain), np.zeros((6, 6))
    held = []
    for index in range(len(record.body)):
        turn, (k, c) = record.axes[index].reshape(3, 3), mount_axes(record, index, 1.0)
        along = turn @ np.diag(k) @ turn.T
        motion = np.hstack((np.eye(3), -_crossing(record.upper[index])))
        stiffness += motion.T @ along @ motion
        held.append(Mount("powertrain", record.upper[index], along, 0.0 * np.diag(c)))
    model = LinearModel(tuple(pair), rest_state(pair), (0.0, 0.0, 0.0), mounts=tuple(held), fixed_root=True)
    found = np.sort([mode.frequency for mode in modes(model)])
    expected = np.sqrt(eigh(stiffness, mass, eigvals_only=True)) / (2.0 * np.pi)
    assert_allclose(found, expected, rtol=1e-6)


def _mass(body):
    """Mass matrix (6, 6) about a body's origin."""
    across = _crossing(body.centre)
    inertia = body.inertia - body.mass * across @ across
    return np.block([[body.mass * np.eye(3), -body.mass * across], [body.mass * across, inertia]])


def _crossing(place):
    x, y, z = place
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def test_mounts_in_a_row_are_their_sum():
    """Two mounts at one place with half the stiffness each are as one: the powertrain rests and shares as before."""
    vehicle = made(5, 0.0, 0, 2, False, True, 4, 0, None)
    rubber = vehicle.mount_types["rubber"]
    half = rubber.model_copy(update={"stiffness": [0.5 * k for k in rubber.stiffness], "damping": rubber.damping})
    doubled = {f"{name}_{k}": mount for name, mount in vehicle.mounts.items() for k in "ab"}
    other = vehicle.model_copy(update={"mount_types": {"rubber": half}, "mounts": doubled})
    one, two = (static_equilibrium(standing(each), 1.0).tree for each in (vehicle, other))
    assert_allclose(two.position, one.position, atol=1e-9)
    alone, shared = loads_at_rest(vehicle), loads_at_rest(other)
    for name, load in alone.items():
        assert_allclose(shared[f"{name}_a"] + shared[f"{name}_b"], load, rtol=1e-9, atol=1e-6)


@settings(FEW, max_examples=3)
@given(vehicle=st.sampled_from(["elastic", "free"]).flatmap(lambda hinge: vehicles(coils=2, cabin=hinge)))
def test_numbering_does_not_matter(simulation, level, vehicle):
    """Mounts and bodies listed backwards, and numbered so, shake under the engine as before, to rounding."""

    def backwards(items):
        return dict(reversed(items.items()))

    # a body stands behind its parent: what may change places is what hangs on the hull
    onto_hull = {name: body for name, body in vehicle.bodies.items() if body.parent == "hull"}
    others = {name: body for name, body in vehicle.bodies.items() if name not in onto_hull}
    bodies = backwards(onto_hull) | others
    other = vehicle.model_copy(update={"bodies": bodies, "mounts": backwards(vehicle.mounts)})
    assert list(other.mounts) != list(vehicle.mounts)
    physics = recommended_rate(vehicle)
    one, two = (
        run_open_loop(simulation(0.0, 1650.0, physics=physics, vehicle=each), level, 200).specific_force
        for each in (vehicle, other)
    )
    assert one[:, 1].std() > 0.01  # m/s^2, of the powertrain
    assert_allclose(two, one, atol=1e-6)


@FEW
@given(vehicle=vehicles())
def test_sensors_are_chassis_powertrain_and_the_files(vehicle):
    """Every vehicle has these two, between its mounts, and those that its file lists."""
    names = [sensor.name for sensor in sensors_of(vehicle)]
    assert names == ["chassis", "powertrain", *vehicle.sensors]
