"""Writes into a bag what simulator and controller would have published, without their nodes."""

from mr_mount_controller.node_base import topics
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from trackvib_msgs.msg import CoilCurrent

from ..numerics.units import NANO
from ..simulation.readings import Readings
from .health import progress
from .messages import DriveMessage, ImuMessage, MountMessage, OdometryMessage, diagnostics, set_stamp
from .output import DIAGNOSTICS_RATE


class RerunBag:
    """Period by period, on those topics that the bag knows."""

    def __init__(self, writer, known, namespace, simulation):
        """Take a `BagWriter`, the names of its topics, what stands before the relative ones, and the simulation."""
        self._writer, self._known, self._namespace, self._simulation = writer, known, namespace, simulation
        rates = simulation.settings.rates
        self._periods_an_odometry = rates.control // rates.odometry
        self._periods_a_diagnosis = rates.control // DIAGNOSTICS_RATE
        self._readings = Readings(simulation)
        self._imus = {sensor.name: ImuMessage(topics.imu_frame(sensor.name)) for sensor in simulation.sensors}
        self._mounts, self._odometry = MountMessage(simulation.sample.mounts), OdometryMessage()
        self._drive, self._clock, self._answer = DriveMessage(), Clock(), CoilCurrent()

    def begin(self):
        """Write where the vehicle stands before the first period."""
        self._write_odometry()

    def write_period(self, lockstep):
        """Write the sample of the last period and its answer, which a `Lockstep` holds."""
        simulation = self._simulation
        stamp, sample = simulation.time, simulation.sample
        for sensor, reading in self._readings.take().items():
            self._write(topics.imu_topic(sensor), self._imus[sensor].fill(stamp, *reading))
        self._write(topics.MOUNT_STATE, self._mounts.fill(stamp, sample.mounts))
        if simulation.periods % self._periods_an_odometry == 0:
            self._write_odometry()
        if simulation.periods % self._periods_a_diagnosis == 0:
            self.write_diagnostics("running", lockstep)
        set_stamp(self._answer, stamp)
        self._answer.sample_stamp = self._answer.header.stamp
        self._answer.current = lockstep.currents.tolist()
        self._write(topics.COIL_CURRENT, serialize_message(self._answer))

    def write_diagnostics(self, state, lockstep):
        """Write the state of the run and what it tells."""
        values = {"state": state, "epoch": 1, **progress(self._simulation, lockstep)}
        level = "error" if state == "failed" else "ok"
        self._write(topics.DIAGNOSTICS, serialize_message(diagnostics(self._simulation.time, level, state, values)))

    def _write_odometry(self):
        simulation, clock = self._simulation, self._clock
        clock.clock.sec, clock.clock.nanosec = divmod(simulation.time, NANO)
        odometry = self._odometry.fill(simulation.time, simulation.state.tree, simulation.sample)
        self._write(topics.ODOMETRY, odometry)
        drive = self._drive.fill(simulation.time, simulation.system, simulation.state)
        self._write(topics.DRIVE_STATE, drive)
        self._write(topics.CLOCK, serialize_message(clock))

    def _write(self, topic, data):
        for name in (self._namespace + topic, f"/{topic}"):  # older bags have some topics outside the namespace
            if name in self._known:
                self._writer.write(name, self._simulation.time, data)
                return
