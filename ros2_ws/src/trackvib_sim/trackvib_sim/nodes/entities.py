"""The bodies of the vehicle as entities of the standard simulation interfaces."""

from math import nan

from mr_mount_controller.node_base.topics import ROAD_FRAME, VEHICLE_DESCRIPTION
from simulation_interfaces.msg import EntityState

from ..scene.frames import frame_name
from ..scene.poses import PoseReader
from ..vehicle.vehicle_file import parse_vehicle
from .messages import set_stamp, set_vector


class Entities:
    """Where the bodies of a simulation are, by the names of their frames.

    Attributes
    ----------
    names : list of str
    """

    def __init__(self, simulation, vehicle_text):
        self._simulation = simulation
        self._poses = PoseReader(parse_vehicle(vehicle_text, VEHICLE_DESCRIPTION), simulation.system)
        self.names = [frame_name(name) for name in self._poses.names]

    def state(self, name):
        """Return the `EntityState` of a body on the road's axes; KeyError if there is none of that name.

        Accelerations are not told: they are no numbers.
        """
        if name not in self.names:
            raise KeyError(name)
        body, message, state = self.names.index(name), EntityState(), self._simulation.state
        pose = self._poses.read(state)
        velocity, turning = self._poses.velocities(state)
        set_stamp(message, self._simulation.time)
        message.header.frame_id = ROAD_FRAME
        set_vector(message.pose.position, pose.place[body].tolist())
        o = message.pose.orientation
        o.x, o.y, o.z, o.w = pose.attitude[body].tolist()
        set_vector(message.twist.linear, velocity[body].tolist())
        set_vector(message.twist.angular, turning[body].tolist())
        set_vector(message.acceleration.linear, (nan, nan, nan))
        set_vector(message.acceleration.angular, (nan, nan, nan))
        return message
