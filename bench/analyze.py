"""How long an hour's bag takes to be read and analysed, and in how much memory, beside rosbags.

    ./trackvib exec -- python bench/analyze.py --minutes 60

The bag is written first, into a temporary folder, by the recorder's own writer: both Imu, mount states, currents
(1 kHz each) and odometry, with noise for numbers. Reading and measuring are timed one after the other; rosbags' reader
decodes the first messages of the same bag, one by one as it does, and its time is scaled to all. Memory is the process's
own, sampled; the columns in temporary files, of which the system keeps what it has room for, are shown beside it.
"""

import os
import threading
import time
from importlib import import_module
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import numpy as np
from machine import machine
from rclpy.serialization import serialize_message
from rich.console import Console
from rich.table import Table
from rosbags.highlevel import AnyReader
from trackvib_sim.analysis.bag_analysis import analyse
from trackvib_sim.bags.cdr_layout import find_layout, type_store
from trackvib_sim.bags.recording import read_recording
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.bags.writing import BagWriter

RATE = 1000  # Hz
PERIOD = 1_000_000  # ns
TOPICS = {  # type, stamp, vectors of noise, every how many periods
    "/chassis/imu": ("sensor_msgs/msg/Imu", "header.stamp", {"linear_acceleration": (3,), "angular_velocity": (3,)}, 1),
    "/powertrain/imu": ("sensor_msgs/msg/Imu", "header.stamp", {"linear_acceleration": (3,)}, 1),
    "/mount_state": ("trackvib_msgs/msg/MountState", "header.stamp", {"current": (2,), "force": (2, 3)}, 1),
    "/coil_current": ("trackvib_msgs/msg/CoilCurrent", "sample_stamp", {"current": (2,)}, 1),
    "/odometry": ("nav_msgs/msg/Odometry", "header.stamp", {"twist.twist.linear": (3,)}, 10),
}
DECODED = 100_000  # messages, by the peer


def write(path, minutes):
    """Write a bag, a minute at a time."""
    random, bag, templates = np.random.default_rng(1), BagWriter(path), {}
    for topic, (type_name, stamp, vectors, _) in TOPICS.items():
        bag.add_topic(topic, type_name, [], "")
        package, kind, name = type_name.split("/")
        message = serialize_message(getattr(import_module(f"{package}.{kind}"), name)())
        store = type_store(type_name, "ros2msg", schema_text(type_name).encode())
        wanted = {f"{stamp}.sec": (), f"{stamp}.nanosec": (), **vectors}
        templates[topic] = find_layout(store, type_name, message, wanted).numbers, message
    for minute in range(minutes):
        columns = []
        for topic, (_, stamp, vectors, every) in TOPICS.items():
            numbers, message = templates[topic]
            times = np.arange(minute * 60 * RATE + every, (minute + 1) * 60 * RATE + 1, every) * PERIOD
            records = np.frombuffer(message * len(times), numbers).copy()
            records[f"{stamp}.sec"], records[f"{stamp}.nanosec"] = np.divmod(times, 10**9)
            for name, shape in vectors.items():
                records[name] = random.normal(size=(len(times), *shape))
            columns.append((topic, every, times.tolist(), memoryview(records.tobytes()), len(message)))
        for k in range(60 * RATE):
            for topic, every, times, data, size in columns:
                if (k + 1) % every == 0:
                    index = (k + 1) // every - 1
                    bag.write(topic, times[index], data[index * size : (index + 1) * size])
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


def peer(path):
    """Return seconds a message of rosbags' reader, all five topics decoded."""
    with AnyReader([path]) as reader:
        begin = time.perf_counter()
        for connection, _, data in islice(reader.messages(), DECODED):
            reader.deserialize(data, connection.msgtype)
        return (time.perf_counter() - begin) / DECODED


@click.command()
@click.option("--minutes", type=click.IntRange(2, 600), default=60, show_default=True, help="Length of the bag.")
@click.option("--folder", type=click.Path(exists=True, file_okay=False), default=None,
              help="Where the bag and the columns lie for a while.  [default: the system's temporary folder]")
def main(minutes, folder):
    """Write, read, measure, print."""
    if folder:
        os.environ["TMPDIR"] = folder
    console = Console()
    with TemporaryDirectory(dir=folder) as place:
        path = Path(place) / "bag"
        count = write(path, minutes)
        size = sum(file.stat().st_size for file in path.iterdir())
        console.print(f"{machine()}\nbag of {minutes} min: {count} messages, {size / 1e6:.0f} MB")
        each = peer(path)
        memory = PeakMemory()
        memory.start()
        begin = time.perf_counter()
        recording = read_recording(path)
        read = time.perf_counter()
        analyse(recording)
        end = time.perf_counter()
        memory.stop()
    table = Table(title="an analysis, and reading alone by the peer")
    for name in ("", "s", "messages/s", "peer's time over it"):
        table.add_column(name, justify="right")
    for name, seconds in (("read", read - begin), ("measure", end - read), ("both", end - begin), ("peer", each * count)):
        table.add_row(name, f"{seconds:.1f}", f"{count / seconds:.3g}", f"{each * count / seconds:.1f}")
    console.print(table)
    console.print(f"memory: {memory.own:.0f} MB own at most, {memory.mapped:.0f} MB of mapped files beside it")


if __name__ == "__main__":
    main()
