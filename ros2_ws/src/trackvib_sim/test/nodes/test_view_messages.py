"""Messages for viewers: a pose goes through them and comes out again; what does not fit its vehicle is refused."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.nodes.view_messages import RoadMessage, TrackLinksMessage, TransformsMessage
from trackvib_sim.road.store import Road
from trackvib_sim.scene.frames import FrameTree
from trackvib_sim.scene.pose_messages import PoseAssembly
from trackvib_sim.scene.poses import Pose, PoseReader
from trackvib_sim.vehicle.drive.path import new_path
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import read_vehicle

pytestmark = pytest.mark.property
STAMP = 1_250_000_000  # ns


def some_pose(vehicle, system):
    """A pose with every body somewhere."""
    random, links = np.random.default_rng(5), system.tracks.chain.links
    bodies = len(PoseReader(vehicle, system).names)
    turns = Rotation.from_rotvec(random.uniform(-1.0, 1.0, (bodies, 3))).as_quat()
    pins = tuple(random.uniform(-3.0, 3.0, (int(count), 3)) for count in links)
    place = random.uniform(-3.0, 3.0, (bodies, 3))
    return Pose(place, turns, pins)


@pytest.fixture(params=vehicle_names())
def told(request):
    """A vehicle, a pose, and the two messages that tell it."""
    vehicle, _ = read_vehicle(find_vehicle(request.param))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    pose, tree = some_pose(vehicle, system), FrameTree(vehicle)
    frames = TransformsMessage(tree.joints).fill(STAMP, *tree.relative(pose))
    return vehicle, pose, frames, TrackLinksMessage(system.tracks.chain.links).fill(STAMP, pose.pins)


def test_a_pose_comes_out_again(told):
    """Whichever of both messages comes first; one of another time completes nothing."""
    vehicle, pose, frames, tracks = told
    for first, second in (("take_frames", "take_tracks"), ("take_tracks", "take_frames")):
        assembly = PoseAssembly(vehicle)
        messages = {"take_frames": frames, "take_tracks": tracks}
        assert getattr(assembly, first)(messages[first]) is None
        stamp, found = getattr(assembly, second)(messages[second])
        assert stamp == STAMP
        np.testing.assert_allclose(found.place, pose.place, atol=1e-9)
        same = np.abs(np.sum(found.attitude * pose.attitude, axis=1))  # a quaternion and its negative are one
        np.testing.assert_allclose(same, 1.0, atol=1e-9)
        for one, other in zip(found.pins, pose.pins, strict=True):
            np.testing.assert_array_equal(one, other)
    tracks.markers[0].header.stamp.sec += 1
    assert assembly.take_tracks(tracks) is None


def spoil(frames, tracks, how):
    """Make one of the messages one that fits no vehicle."""
    if how == "no place":
        frames.transforms[3].transform.translation.x = float("nan")
    elif how == "no turn":
        q = frames.transforms[3].transform.rotation
        q.x = q.y = q.z = q.w = 0.0
    elif how == "a ring":
        frames.transforms[0].header.frame_id = "left_wheel_1"
    elif how == "a body missing":
        frames.transforms.pop()
    elif how == "a track missing":
        tracks.markers = tracks.markers[:1]
    elif how == "a link missing":
        tracks.markers[1].points = tracks.markers[1].points[:-2]
    else:
        tracks.markers[0].points[8].z = float("inf")


@pytest.mark.parametrize(
    "how", ["no place", "no turn", "a ring", "a body missing", "a track missing", "a link missing", "no pin"]
)
def test_what_does_not_fit_is_refused(told, how):
    """By errors that their readers know."""
    vehicle, _, frames, tracks = told
    spoil(frames, tracks, how)
    assembly = PoseAssembly(vehicle)
    with pytest.raises((ValueError, LookupError)):
        assembly.take_frames(frames)
        assembly.take_tracks(tracks)


def test_road_lies_where_it_was_measured(vehicle):
    """Corners have the heights of the samples, left and right, as far around the vehicle as is told."""
    first, spacing, count = -300, 0.05, 1200
    distance = spacing * (first + np.arange(count))
    heights = np.stack((0.02 * np.sin(distance), -0.01 * np.cos(distance)))
    marker = RoadMessage(vehicle).fill(STAMP, Road(first, spacing, heights), new_path())
    corners = np.array([(point.x, point.y, point.z) for point in marker.points])
    assert -12.1 < corners[:, 0].min() < -11.8 and 24.8 < corners[:, 0].max() < 25.1
    wanted = np.where(corners[:, 1] > 0.0, 0.02 * np.sin(corners[:, 0]), -0.01 * np.cos(corners[:, 0]))
    np.testing.assert_allclose(corners[:, 2], wanted, atol=1e-12)
    faces = corners.reshape(-1, 3, 3)
    assert np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])[:, 2].min() > 0.0  # they look up
