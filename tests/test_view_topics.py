"""What the nodes publish for viewers, over real DDS and in a bag: frames, joints, description, track links, road."""

import io

import numpy as np
import pinocchio
import pytest
import yaml
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from rclpy.serialization import deserialize_message
from rich.console import Console
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.nodes.loop_arguments import closed_loop_parameters
from trackvib_sim.view.motion import Span, read_motion
from trackvib_sim.view.recorded_poses import read_recorded_poses
from visualization_msgs.msg import Marker, MarkerArray

pytestmark = pytest.mark.system

RATE = 50
NEAR = 1e-9  # m; frames on their parents are put together again
JAZZY = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"  # of tf2_msgs/msg/TFMessage


@pytest.fixture
def drive(start_node, observer, tmp_path):
    """Run the loop with a view rate: `drive(pace)`; returns the bag and what an observer got by topic."""
    pattern = yaml.safe_load(closed_loop_parameters().read_text())["/**/recorder"]["ros__parameters"]["pattern"]

    def run(**parameters):
        got = {
            topics.TF: observer.collect(TFMessage, topics.TF, LOOP_WRITER_QOS),
            topics.TF_STATIC: observer.collect(TFMessage, topics.TF_STATIC, LATCHED_QOS),
            topics.JOINT_STATES: observer.collect(JointState, topics.JOINT_STATES, LOOP_WRITER_QOS),
            topics.ROBOT_DESCRIPTION: observer.collect(String, topics.ROBOT_DESCRIPTION, LATCHED_QOS),
            topics.TRACK_LINKS: observer.collect(MarkerArray, topics.TRACK_LINKS, LOOP_WRITER_QOS),
            topics.ROAD_STRIPS: observer.collect(Marker, topics.ROAD_STRIPS, LATCHED_QOS),
        }
        recorder = start_node("recorder", bag=tmp_path / "bag", pattern=f"'{pattern}'")
        start_node("road_excitation")
        simulator = start_node("simulator", view_rate=RATE, wait_for_recorder=True, **parameters)
        # who listens has found it before the last partner lets it run
        known = [*got, topics.DIAGNOSTICS]
        observer.wait_until(lambda: all(observer.node.count_publishers(topic) for topic in known))
        start_node("controller", wait_for_recorder=True)
        observer.wait_for(state="finished")
        observer.wait_until(lambda: len(got[topics.TF]) > 1 and len(got[topics.TRACK_LINKS]) > 1)
        assert simulator.wait() == 0, simulator.output
        recorder.signal(2)
        assert recorder.wait() == 0, recorder.output
        return tmp_path / "bag", got

    return run


@pytest.mark.slow(reason="drives the run again in this process")
def test_frames_of_a_run_in_lockstep(drive):
    """All kinds arrive and fit each other; the poses in the bag are those of driving it again, to the last digits."""
    bag, got = drive(duration=0.6)
    frames = [deserialize_message(data, TFMessage) for data in got[topics.TF]]
    (fixed,) = (deserialize_message(data, TFMessage) for data in got[topics.TF_STATIC][:1])
    states = [deserialize_message(data, JointState) for data in got[topics.JOINT_STATES]]
    model = pinocchio.buildModelFromXML(deserialize_message(got[topics.ROBOT_DESCRIPTION][0], String).data)
    parents = {each.child_frame_id: each.header.frame_id for each in (*frames[-1].transforms, *fixed.transforms)}
    assert parents["base_link"] == "odom" and parents["chassis_imu_link"] == "base_link"
    assert parents["powertrain_imu_link"] == "powertrain" and parents["left_idler"] == "left_tensioner"
    assert set(parents) == {frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY} - {
        "universe"
    }
    assert all(model.existJointName(name) for name in states[-1].name)
    tracks = deserialize_message(got[topics.TRACK_LINKS][-1], MarkerArray).markers
    assert [len(track.points) for track in tracks] == [240, 240]
    road = deserialize_message(got[topics.ROAD_STRIPS][-1], Marker)
    assert len(road.points) == len(road.colors) > 300 and len(road.points) % 3 == 0

    recording = read_recording(bag)
    vehicle, motion = read_motion(recording, Span(RATE), Console(file=io.StringIO()))
    time, poses = read_recorded_poses(recording, vehicle, Span(RATE, 0.0, 10.0))
    again = dict(zip(motion.time.tolist(), motion.poses, strict=True))
    common = [(pose, again[stamp]) for stamp, pose in zip(time.tolist(), poses, strict=True) if stamp in again]
    assert motion.note == "" and len(common) >= 0.6 * RATE - 2
    for recorded, driven in common:
        np.testing.assert_allclose(recorded.place, driven.place, atol=NEAR, rtol=0.0)
        for one, other in zip(recorded.pins, driven.pins, strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.slow(reason="a drive in real time")
def test_frames_of_a_run_in_real_time(drive):
    """A bag that depends on the machine is shown from its frames."""
    bag, _ = drive(duration=0.6, pace="realtime", real_time_factor=0.2)
    vehicle, motion = read_motion(read_recording(bag), Span(RATE), Console(file=io.StringIO()))
    assert len(motion.poses) >= 10 and np.all(np.diff(motion.time) > 0)
    moved = motion.poses[-1].place[0, 0] - motion.poses[0].place[0, 0]
    assert moved == pytest.approx(10.0 * (motion.time[-1] - motion.time[0]) / 1e9, rel=0.02)
    assert motion.way.distance[-1] > motion.way.distance[0]


def test_the_message_of_tf_is_jazzys_own(observer):
    """Whoever built it: nodes of any ROS 2 Jazzy take ours for theirs."""
    observer.node.create_publisher(TFMessage, topics.TF, 1)
    observer.wait_until(lambda: observer.node.get_publishers_info_by_topic(topics.TF))
    (info,) = observer.node.get_publishers_info_by_topic(topics.TF)
    assert str(info.topic_type_hash) == JAZZY
