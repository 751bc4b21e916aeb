"""What the simulator publishes: its publishers, and when each has something to say."""

import time

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistStamped
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.qos import CLOCK_QOS, LATCHED_QOS, LOOP_WRITER_QOS
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import DriveState, MountDescription, MountState

from ..numerics.units import NANO
from ..simulation.readings import Readings
from ..simulation.simulation import POWERTRAIN
from .messages import DriveMessage, ImuMessage, MountMessage, OdometryMessage, diagnostics, mount_description, set_stamp

DIAGNOSTICS_RATE = 10  # Hz of simulated time
_FLUSH = 4.0  # s for the last messages to arrive


class SimulatorOutput:
    """All publishers of the simulator node."""

    def __init__(self, node, simulation, vehicle_text, drive_text):
        self._further = _further_outputs(node, simulation, vehicle_text)
        self._simulation = simulation
        rates = simulation.settings.rates
        self._periods_an_odometry = rates.control // rates.odometry
        self._readings, sensors = Readings(simulation), [sensor.name for sensor in simulation.sensors]
        self._imus = {sensor: ImuMessage(topics.imu_frame(sensor)) for sensor in sensors}
        self._mounts, self._odometry, self._time = MountMessage(simulation.sample.mounts), OdometryMessage(), Clock()
        # whoever waits for chassis and powertrain finds the others there as well
        self._imu_out = {
            sensor: node.create_publisher(Imu, topics.imu_topic(sensor), LOOP_WRITER_QOS)
            for sensor in reversed(sensors)
        }
        self._loop_out = [self._imu_out[sensor] for sensor in sensors[: POWERTRAIN + 1]]
        self._mount_out = node.create_publisher(MountState, topics.MOUNT_STATE, LOOP_WRITER_QOS)
        self._odometry_out = node.create_publisher(Odometry, topics.ODOMETRY, LATCHED_QOS)
        self._drive, self._command = DriveMessage(), TwistStamped()
        self._command.header.frame_id = topics.HULL_FRAME
        self._drive_out = node.create_publisher(DriveState, topics.DRIVE_STATE, LATCHED_QOS)
        self._command_out = node.create_publisher(TwistStamped, topics.DRIVE_COMMAND, LATCHED_QOS)
        self._clock_out = node.create_publisher(Clock, topics.CLOCK, CLOCK_QOS)
        self._diagnostics_out = node.create_publisher(DiagnosticArray, topics.DIAGNOSTICS, LOOP_WRITER_QOS)
        self._vehicle_out = node.create_publisher(String, topics.VEHICLE_DESCRIPTION, LATCHED_QOS)
        self._vehicle_text, self._drive_text = vehicle_text, drive_text
        self._drive_file_out = node.create_publisher(String, topics.DRIVE_DESCRIPTION, LATCHED_QOS)
        self._description_out = node.create_publisher(MountDescription, topics.MOUNT_DESCRIPTION, LATCHED_QOS)

    def introduce(self):
        """Publish what the partners need before the start: where the vehicle stands, what it is, and its mounts.

        The time comes first, for it may tell them that a new run begins.
        """
        self.publish_odometry()
        self._description_out.publish(mount_description(self._simulation.mounting))
        self._vehicle_out.publish(String(data=self._vehicle_text))
        self._drive_file_out.publish(String(data=self._drive_text))
        for output in self._further:
            output.introduce()

    @property
    def loop_publishers(self):
        """Of the Imu of the chassis and of the powertrain."""
        return tuple(self._loop_out)

    def listeners(self):
        """Return how many listen to the Imu of the chassis and of the powertrain."""
        return [publisher.get_subscription_count() for publisher in self._loop_out]

    def publish_sample(self):
        """Publish the sample of the last period; odometry and clock where it is their turn."""
        simulation, stamp = self._simulation, self._simulation.time
        # the accelerations first, of chassis and powertrain: whoever answers them works while the rest is published
        for sensor, reading in self._readings.take().items():
            self._imu_out[sensor].publish(self._imus[sensor].fill(stamp, *reading))
        self._mount_out.publish(self._mounts.fill(stamp, simulation.sample.mounts))
        if simulation.periods % self._periods_an_odometry == 0:
            self.publish_odometry()
        for output in self._further:
            output.publish_in_turn()

    def publish_odometry(self):
        """Publish where the vehicle is, how it is driven, and the clock."""
        simulation = self._simulation
        odometry = self._odometry.fill(simulation.time, simulation.state.tree, simulation.sample)
        self._odometry_out.publish(odometry)
        self._drive_out.publish(self._drive.fill(simulation.time, simulation.system, simulation.state))
        self.publish_clock()

    def publish_command(self, speed, yaw_rate):
        """Publish a speed [m/s] and yaw rate [rad/s] that are in force from now on."""
        set_stamp(self._command, self._simulation.time)
        self._command.twist.linear.x, self._command.twist.angular.z = speed, yaw_rate
        self._command_out.publish(self._command)

    def publish_clock(self):
        """Publish the simulated time."""
        simulation = self._simulation
        self._time.clock.sec, self._time.clock.nanosec = divmod(simulation.time, NANO)
        self._clock_out.publish(self._time)

    def publish_diagnostics(self, level, state, values):
        """Publish the simulator's health: level "ok", "warning" or "error", its state and what it counts."""
        self._diagnostics_out.publish(diagnostics(self._simulation.time, level, state, values))

    def flush(self):
        """Let what was published arrive."""
        end = time.monotonic() + _FLUSH
        for publisher in (*self._imu_out.values(), self._mount_out, self._odometry_out, self._diagnostics_out):
            publisher.wait_for_all_acked(Duration(seconds=max(end - time.monotonic(), 0.0)))


def _further_outputs(node, simulation, vehicle_text):
    """What has a rate of its own, which most runs leave at zero."""
    if not (node.settings["view_rate"] or node.settings["measure_rate"]):
        return []
    from ..vehicle.vehicle_file import parse_vehicle  # imported late: a run without them does not wait for it
    from .measured_output import MeasuredOutput
    from .view_output import ViewOutput

    vehicle = parse_vehicle(vehicle_text, "vehicle file")
    kinds = ((ViewOutput, node.settings["view_rate"]), (MeasuredOutput, node.settings["measure_rate"]))
    return [kind(node, simulation, vehicle, rate) for kind, rate in kinds if rate]
