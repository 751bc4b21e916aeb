"""How long an hour's bag takes to be read, analysed and reported on, and in how much memory, beside rosbags.

    ./trackvib exec -- python bench/analyze.py --minutes 60

The bag is written first, into a temporary folder, by the recorder's own writer: both Imu, mount states, currents
(1 kHz each) and odometry, with noise for numbers; road and diagnostics as often as in a run. The steps of
`trackvib analyze` are timed one after the other, on the clock and in processor time, which counts on a busy machine;
rosbags' reader decodes the first messages of the same bag, one by one as it does, and its time is scaled to all. Memory
is the process's own, sampled; the columns in temporary files, of which the system keeps what it has room for, are shown
beside it.
"""

import threading
import time
from collections.abc import Sequence
from importlib import import_module
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Vector3
from machine import machine
from mr_mount_controller.node_base.cdr import find_layout
from rclpy.serialization import serialize_message
from rich.console import Console
from rich.table import Table
from rosbags.highlevel import AnyReader
from trackvib_msgs.msg import RoadProfile
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.bag_tables import write_tables
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.report_data import build_report_data
from trackvib_sim.bags.definitions import Definition
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.bags.writing import BagWriter

RATE = 1000  # Hz
PERIOD = 1_000_000  # ns
IMU = {"linear_acceleration": (3,), "angular_velocity": (3,)}
MOUNTS = dict.fromkeys(("current", "stiffness", "damping", "dissipated_power"), (2,)) | dict.fromkeys(
    ("deflection", "velocity", "force"), (2, 3)
)
TOPICS = {  # type, stamp, fields of noise, every how many periods
    "/chassis/imu": ("sensor_msgs/msg/Imu", "header.stamp", IMU, 1),
    "/powertrain/imu": ("sensor_msgs/msg/Imu", "header.stamp", IMU, 1),
    "/mount_state": ("trackvib_msgs/msg/MountState", "header.stamp", MOUNTS, 1),
    "/coil_current": ("trackvib_msgs/msg/CoilCurrent", "sample_stamp", {"current": (2,)}, 1),
    "/odometry": ("nav_msgs/msg/Odometry", "header.stamp", {"twist.twist.linear": (3,)}, 10),
}
DECODED = 100_000  # messages, by the peer


def rare_messages():
    """Return type, distance in periods, and a message by topic."""
    heights = np.zeros(100)
    values = [KeyValue(key=name, value="0") for name in ("silent_periods", *map(str, range(30)))]
    status = DiagnosticArray(status=[DiagnosticStatus(name="simulator", values=values)])
    road = RoadProfile(spacing=0.05, left=heights, right=heights)
    return {
        "/diagnostics": ("diagnostic_msgs/msg/DiagnosticArray", 100, serialize_message(status)),
        "/road_profile": ("trackvib_msgs/msg/RoadProfile", 500, serialize_message(road)),
    }


def write(path, minutes):
    """Write a bag, a minute at a time."""
    random, bag, templates, rare = np.random.default_rng(1), BagWriter(path), {}, rare_messages()
    for topic, (type_name, _, _) in rare.items():
        bag.add_topic(topic, type_name, [], "")
    for topic, (type_name, stamp, noise, _) in TOPICS.items():
        bag.add_topic(topic, type_name, [], "")
        package, kind, name = type_name.split("/")
        empty = getattr(import_module(f"{package}.{kind}"), name)()
        empty.header.frame_id = "some_frame"
        if topic == "/odometry":
            empty.child_frame_id = "another"
        for field, (size, *vector) in noise.items():
            if isinstance(getattr(empty, field.partition(".")[0]), Sequence):
                setattr(empty, field, [Vector3() if vector else 0.0 for _ in range(size)])
        message = serialize_message(empty)
        definition = Definition(type_name, "ros2msg", schema_text(type_name).encode())
        wanted = {f"{stamp}.sec": (), f"{stamp}.nanosec": (), **noise}
        templates[topic] = find_layout(definition.kind, message, wanted).numbers, message
    for minute in range(minutes):
        columns = []
        for topic, (_, stamp, noise, every) in TOPICS.items():
            numbers, message = templates[topic]
            times = np.arange(minute * 60 * RATE + every, (minute + 1) * 60 * RATE + 1, every) * PERIOD
            data = bytearray(message * len(times))
            records = np.frombuffer(data, numbers)
            records[f"{stamp}.sec"], records[f"{stamp}.nanosec"] = np.divmod(times, 10**9)
            for name, shape in noise.items():
                records[name] = random.normal(size=(len(times), *shape))
            columns.append((topic, every, times.tolist(), memoryview(data), len(message)))
        for k in range(60 * RATE):
            for topic, every, times, data, size in columns:
                if (k + 1) % every == 0:
                    index = (k + 1) // every - 1
                    bag.write(topic, times[index], data[index * size : (index + 1) * size])
            for topic, (_, every, data) in rare.items():
                if (k + 1) % every == 0:
                    bag.write(topic, (minute * 60 * RATE + k + 1) * PERIOD, data)
    bag.close()
    return bag.counts.total()


class PeakMemory(threading.Thread):
    """Watches this process's own memory, and with it the mapped files [MB]."""

    def __init__(self):
        super().__init__(daemon=True)
        self.own, self.mapped, self._stop_it = 0.0, 0.0, threading.Event()

    def run(self):
        """Look every 20 ms."""
        while not self._stop_it.wait(0.02):
            words = Path("/proc/self/status").read_text().split()
            own, mapped = (int(words[words.index(name) + 1]) / 1e3 for name in ("RssAnon:", "RssFile:"))
            self.own, self.mapped = max(self.own, own), max(self.mapped, mapped)

    def stop(self):
        """End it."""
        self._stop_it.set()
        self.join()


class Stopwatch:
    """Seconds since it was made: on the clock, and of the processor."""

    def __init__(self):
        self._begin = self._now()

    def _now(self):
        return np.array((time.perf_counter(), time.process_time()))

    def lap(self):
        """Return the seconds since the last lap."""
        last, self._begin = self._begin, self._now()
        return self._begin - last


def peer(path):
    """Return seconds a message of rosbags' reader, all five topics decoded."""
    with AnyReader([path]) as reader:
        watch = Stopwatch()
        for connection, _, data in islice(reader.messages(), DECODED):
            reader.deserialize(data, connection.msgtype)
        return watch.lap() / DECODED


@click.command()
@click.option("--minutes", type=click.IntRange(2, 600), default=60, show_default=True, help="Length of the bag.")
def main(minutes):
    """Write, read, measure, print."""
    console = Console()
    with TemporaryDirectory() as place:
        path = Path(place) / "bag"
        count = write(path, minutes)
        size = sum(file.stat().st_size for file in path.iterdir())
        console.print(f"{machine()}\nbag of {minutes} min: {count} messages, {size / 1e6:.0f} MB")
        theirs = peer(path) * count
        memory = PeakMemory()
        memory.start()
        watch = Stopwatch()
        recording = read_recording(path)
        read = watch.lap()
        analysis = analyse(recording)
        measured = watch.lap()
        write_tables([analysis], Path(place))
        write_report([build_report_data(recording, analysis)], Path(place) / "report.html")
        written = watch.lap()
        memory.stop()
    table = Table(title="an analysis, and the peer's reading alone, of all messages")
    for name in ("", "s", "s of processor", "messages/s", "peer's time over it"):
        table.add_column(name, justify="right")
    laps = {"read": read, "measure": measured, "tables and report": written, "all": read + measured + written}
    for name, seconds in (laps | {"peer": theirs}).items():
        clock, processor = seconds
        ratio = theirs[1] / processor
        table.add_row(name, f"{clock:.1f}", f"{processor:.1f}", f"{count / clock:.3g}", f"{ratio:.1f}")
    console.print(table)
    console.print(f"memory: {memory.own:.0f} MB own at most, {memory.mapped:.0f} MB of mapped files beside it")


if __name__ == "__main__":
    main()
