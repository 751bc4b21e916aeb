"""Frames and robot description beside Pinocchio, which reads the URDF with a parser of its own."""

import numpy as np
import pinocchio
import pytest
from scipy.spatial.transform import Rotation
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.scene.frames import FrameTree, JointReader, frame_name, sensor_joints
from trackvib_sim.scene.poses import PoseReader, left_axis, link_poses
from trackvib_sim.scene.urdf import urdf
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.system import Operation, build_system, new_state
from trackvib_sim.vehicle.tracks.initial import assemble_tracks
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle

pytestmark = pytest.mark.cross_engine
NEAR = 1e-7  # m; numbers in the text have nine digits


@pytest.fixture(params=vehicle_names())
def scene(request):
    """A vehicle, its system and a state away from its rest, with its tracks laid."""
    vehicle, _ = read_vehicle(find_vehicle(request.param))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    state, random = new_state(system), np.random.default_rng(3)
    assemble_tracks(vehicle, system, state, 0.0, 0.0)
    rows = system.tree.row[system.tree.moves]
    state.tree.hinge[rows] = random.uniform(-0.3, 0.3, len(rows))
    state.tree.position[:] += random.uniform(-0.2, 0.2, state.tree.position.shape)
    turns = Rotation.from_rotvec(random.uniform(-0.2, 0.2, state.tree.position.shape))
    state.tree.attitude[:] = turns.as_quat(scalar_first=True)
    return vehicle, system, state


def free_coordinates(model, tree, pose, joints, state):
    """The coordinates (q,) of Pinocchio's model in a state: of joints, and of the frames that float."""
    q = pinocchio.neutral(model)
    place, attitude = tree.relative(pose)
    position = dict(zip(joints.names, joints.read(state)[0], strict=True))
    for k, joint in enumerate(tree.joints):
        name = "root_joint" if k == 0 else joint.name
        if not model.existJointName(name):
            continue
        each = model.joints[model.getJointId(name)]
        if joint.kind == "floating":
            # of the joint's own frame, which stands at its place on the parent
            q[each.idx_q : each.idx_q + 7] = (*(place[k] - joint.place), *attitude[k])
        elif joint.kind == "continuous":
            q[each.idx_q : each.idx_q + 2] = np.cos(position[name]), np.sin(position[name])
        else:
            q[each.idx_q] = position[name]
    return q


def test_urdf_places_every_body(scene):
    """Joint coordinates put into the URDF give the poses that are published and drawn."""
    vehicle, system, state = scene
    model = pinocchio.buildModelFromXML(urdf(vehicle, system), pinocchio.JointModelFreeFlyer())
    pose, tree = PoseReader(vehicle, system).read(state), FrameTree(vehicle)
    data = model.createData()
    q = free_coordinates(model, tree, pose, JointReader(vehicle, system), state)
    pinocchio.framesForwardKinematics(model, data, q)
    names = [frame_name(body.name) for body in build_body_table(vehicle)]
    for name, place, attitude in zip(names, pose.place, pose.attitude, strict=True):
        there = data.oMf[model.getFrameId(name)]
        np.testing.assert_allclose(there.translation, place, atol=NEAR)
        np.testing.assert_allclose(there.rotation, Rotation.from_quat(attitude).as_matrix(), atol=NEAR)
    for joint in sensor_joints(vehicle):
        assert model.existFrame(joint.child)


def test_urdf_has_all_masses(scene):
    """Nothing but the shoes is left out."""
    vehicle, system, _ = scene
    model = pinocchio.buildModelFromXML(urdf(vehicle, system), pinocchio.JointModelFreeFlyer())
    bodies = sum(body.mass for body in build_body_table(vehicle))
    assert pinocchio.computeTotalMass(model) == pytest.approx(bodies, rel=1e-9)


def test_links_join_pins(scene):
    """Each link lies between two pins, its axis along them, upright to the hull's y axis."""
    vehicle, system, state = scene
    pose = PoseReader(vehicle, system).read(state)
    for pins in pose.pins:
        middles, attitudes = link_poses(pins, left_axis(pose))
        turns = Rotation.from_quat(attitudes)
        length = np.linalg.norm(np.roll(pins, -1, axis=0) - pins, axis=1)
        behind = middles - 0.5 * length[:, None] * turns.as_matrix()[:, :, 0]
        np.testing.assert_allclose(behind, pins, atol=1e-12)
        assert np.abs(turns.as_matrix()[:, :, 2] @ left_axis(pose)).max() < 1e-9


def test_names_of_ours_are_not_taken_twice(vehicle):
    """A body that is called as a frame of ours gets another frame."""
    text = find_vehicle().read_text().replace("turret", "base_link")
    odd = parse_vehicle(text, "odd")
    frames = [frame_name(body.name) for body in build_body_table(odd)]
    assert len(set(frames)) == len(frames) and "base_link_body" in frames
