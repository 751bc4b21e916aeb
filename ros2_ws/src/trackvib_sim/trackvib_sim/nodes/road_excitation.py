"""The road-excitation node: streams the roughness profile ahead of the vehicle."""

import sys

from mr_mount_controller.node_base.descriptors import descriptor_of
from mr_mount_controller.node_base.listener import Refused
from mr_mount_controller.node_base.loop_node import LoopNode
from mr_mount_controller.node_base.node_process import run_node
from mr_mount_controller.node_base.parameters import Parameter, ParameterError
from mr_mount_controller.node_base.plain_text import plain_line, span
from mr_mount_controller.node_base.qos import LATCHED_QOS, ROAD_QOS
from mr_mount_controller.node_base.topics import DRIVE_STATE, ROAD_FRAME, ROAD_PROFILE
from trackvib_msgs.msg import DriveState, RoadProfile

from ..road.classes import CLASSES
from ..road.feeder import RoadFeeder
from ..road.iso8608 import FADE, LEVEL_UNTIL, TREAD, Exponential, Iso8608Road, Isotropic
from ..road_sources.road_file import RoadError, find_road
from ..road_sources.words import composition

PARAMETERS = (
    Parameter("road", "E", "ISO 8608 class, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag."),
    Parameter("seed", 1, "Seed of the profile; the same seed gives the same road.", "", 0, 10**9),
    Parameter(
        "coherence",
        "isotropic",
        "Model of the coherence of left and right profile.",
        choices=("isotropic", "exponential"),
    ),
    Parameter(
        "track_distance", TREAD, "Distance between left and right profile on an isotropic surface.", "m", 0.0, 10.0
    ),
    Parameter(
        "coherence_length", 1.4, "Length l of the coherence exp(-l n) over spatial frequency n.", "m", 0.0, 100.0
    ),
    Parameter("level_until", LEVEL_UNTIL, "Distance up to which the road is level.", "m", -1000.0, 1e6),
    Parameter("fade", FADE, "Distance over which the roughness then rises to its full level.", "m", 0.1, 1000.0),
    Parameter(
        "horizon", 50.0, "Distance ahead of the vehicle for which the road is always published.", "m", 10.0, 200.0
    ),
)
_FARTHEST = 1e8  # m, more than the longest run goes


class RoadExcitationNode(LoopNode):
    """Follows the vehicle along its path and publishes the patches of road that it will need."""

    NAME, PARAMETERS = "road_excitation", PARAMETERS

    def __init__(self):
        super().__init__()
        s = self.settings
        self._road = _road(s)
        begins = Parameter(
            "begins", float(self._road.begins), "Where the road proper begins; follows from the road.", "m"
        )
        consists_of = Parameter("consists_of", composition(self._road), "What the road is; follows from the road.")
        # for whoever analyses a bag: what the road is, and from where on all of the vehicle is on it
        for told in (begins, consists_of):
            self.declare_parameter(told.name, told.default, descriptor_of(told, fixed=True), ignore_override=True)
        self._feeder = RoadFeeder(self._road, s["horizon"])
        self._last = (0, 0)  # stamp of the latest drive state, s and ns
        self._patches = self.create_publisher(RoadProfile, ROAD_PROFILE, ROAD_QOS)
        self.listen(DriveState, DRIVE_STATE, self._on_drive, LATCHED_QOS)
        self.get_logger().info(f"road {plain_line(s['road'])}; waiting for a vehicle")

    def _on_drive(self, drive):
        distance = drive.distance
        if not abs(distance) <= _FARTHEST:  # NaN is not either
            raise Refused(f"distance is {distance} m, accepted: {span(-_FARTHEST, _FARTHEST, 'm')}")
        stamp = (drive.header.stamp.sec, drive.header.stamp.nanosec)
        if stamp <= self._last:  # a new run, or a vehicle that asks again because it still has no road
            self._feeder = RoadFeeder(self._road, self.settings["horizon"])
        self._last = stamp
        for start, spacing, heights in self._feeder.patches(distance):
            patch = RoadProfile(start=start, spacing=spacing, left=heights[0], right=heights[1])
            patch.header.stamp = drive.header.stamp
            patch.header.frame_id = ROAD_FRAME
            self._patches.publish(patch)


def _road(s):
    """Return the road that the parameters' values ask for."""
    if s["road"] in CLASSES:
        isotropic = s["coherence"] == "isotropic"
        coherence = Isotropic(s["track_distance"]) if isotropic else Exponential(s["coherence_length"])
        return Iso8608Road(s["road"], s["seed"], s["level_until"], s["fade"], coherence)
    try:
        return find_road(s["road"], s["track_distance"])
    except RoadError as error:
        raise ParameterError(f"parameter 'road': {error}") from None


def main(args=None):
    """Run the node."""
    sys.exit(run_node(RoadExcitationNode, args))
