"""What the simulator publishes for viewers: frames, joint states, track links, road, and the robot's description."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from ..scene.frames import FrameTree, JointReader, sensor_joints
from ..scene.poses import PoseReader
from ..scene.urdf import urdf
from .view_messages import JointStateMessage, RoadMessage, TrackLinksMessage, TransformsMessage, transforms

ROAD_RATE = 1  # Hz of simulated time


class ViewOutput:
    """Publishers for viewers, at a rate [Hz] of simulated time."""

    def __init__(self, node, simulation, vehicle, rate):
        self._simulation, system = simulation, simulation.system
        control = simulation.settings.rates.control
        self._periods, self._periods_a_road = control // rate, control // ROAD_RATE
        self._poses, self._tree, self._joints = (
            PoseReader(vehicle, system),
            FrameTree(vehicle),
            JointReader(vehicle, system),
        )
        self._sensors, self._text = list(sensor_joints(vehicle)), urdf(vehicle, system)
        self._frames, self._states = TransformsMessage(self._tree.joints), JointStateMessage(self._joints.names)
        self._links = TrackLinksMessage(system.tracks.chain.links)
        self._road = RoadMessage(vehicle)
        self._frames_out = node.create_publisher(TFMessage, topics.TF, LOOP_WRITER_QOS)
        self._static_out = node.create_publisher(TFMessage, topics.TF_STATIC, LATCHED_QOS)
        self._states_out = node.create_publisher(JointState, topics.JOINT_STATES, LOOP_WRITER_QOS)
        self._text_out = node.create_publisher(String, topics.ROBOT_DESCRIPTION, LATCHED_QOS)
        self._links_out = node.create_publisher(MarkerArray, topics.TRACK_LINKS, LOOP_WRITER_QOS)
        self._road_out = node.create_publisher(Marker, topics.ROAD_STRIPS, LATCHED_QOS)

    def introduce(self):
        """Publish what never changes, and where everything is before the first period."""
        self._text_out.publish(String(data=self._text))
        fixed = [(each.parent, each.child, each.place, each.attitude) for each in self._sensors]
        self._static_out.publish(transforms(self._simulation.time, fixed))
        self._publish()

    def publish_in_turn(self):
        """Publish where everything is, if it is time to."""
        if self._simulation.periods % self._periods == 0:
            self._publish()
        simulation = self._simulation
        if simulation.periods % self._periods_a_road == 1:
            path = simulation.state.drive.path
            self._road_out.publish(self._road.fill(simulation.time, simulation.road_at_hand, path))

    def _publish(self):
        simulation = self._simulation
        pose = self._poses.read(simulation.state)
        self._frames_out.publish(self._frames.fill(simulation.time, *self._tree.relative(pose)))
        self._states_out.publish(self._states.fill(simulation.time, *self._joints.read(simulation.state)))
        self._links_out.publish(self._links.fill(simulation.time, pose.pins))
