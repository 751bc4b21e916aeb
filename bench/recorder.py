"""The recorder under load: messages lost and CPU time a message, beside `ros2 bag record` and a mere subscriber.

    ./trackvib exec -- python bench/recorder.py                    # 20 000 messages/s for 60 s, a minute each
    ./trackvib exec -- python bench/recorder.py --seconds 10

A process of its own publishes Imu messages on four topics, as bytes. Each contender in turn gets the same stream;
what it lost is counted in the bag it leaves. `ros2 bag record` takes part where it is installed.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import click
import rclpy
from ament_index_python.packages import get_package_prefix
from machine import machine
from mcap.reader import make_reader
from mr_mount_controller.node_base.loop_node import LoopNode
from mr_mount_controller.node_base.node_process import run_node
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from rich.console import Console
from rich.table import Table
from sensor_msgs.msg import Imu
from trackvib_sim.nodes.messages import ImuMessage

TOPICS = [f"/load/imu_{k}" for k in range(4)]
BATCH = 0.001  # s between bursts, as the loop's periods
NANO = 1_000_000_000
PATIENCE = 60.0  # s
ROLES = ("publish", "count")


def publish(rate, seconds):
    """Publish `rate` messages a second over all topics, once every topic has a subscriber."""
    rclpy.init()
    node = rclpy.create_node("load")
    publishers = [node.create_publisher(Imu, topic, LOOP_WRITER_QOS) for topic in TOPICS]
    message = ImuMessage("load")
    while not all(publisher.get_subscription_count() for publisher in publishers):
        time.sleep(0.05)
    time.sleep(1.0)  # both sides must know of the match
    per_topic = rate // len(TOPICS)
    sent, began = 0, time.monotonic()
    while sent < per_topic * seconds:
        due = min(per_topic * seconds, int((time.monotonic() - began) * per_topic))
        for number in range(sent + 1, due + 1):
            data = message.fill(number * NANO // per_topic, (0.0, 0.0, 9.81), (0.0, 0.0, number))
            for publisher in publishers:
                publisher.publish(data)
        sent = due
        time.sleep(BATCH)
    print(f"published in {time.monotonic() - began:.1f} s", flush=True)
    for publisher in publishers:
        publisher.wait_for_all_acked(Duration(seconds=10))
    rclpy.shutdown()


class Counter(LoopNode):
    """Takes raw messages as a recorder does, and only counts them."""

    NAME = "counter"

    def __init__(self):
        super().__init__()
        self.count = 0
        for topic in TOPICS:
            self.create_subscription(Imu, topic, self._on_message, QoSProfile(depth=1000), raw=True)

    def _on_message(self, _data):
        self.count += 1

    def close(self):
        print(f"{self.count} messages", flush=True)


def measure(name, command, bag, rate, seconds):
    """Run one contender against the load; returns how many messages it has and its CPU time [s]."""
    contender = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # not ignored, as in a script's background
    )
    load = [sys.executable, __file__, "--role", "publish", "--rate", str(rate), "--seconds", str(seconds)]
    try:
        print(f"{name}: {subprocess.check_output(load, text=True, timeout=seconds * 4 + PATIENCE).strip()}")
        time.sleep(1.0)
        os.killpg(contender.pid, signal.SIGINT)
        said = contender.stdout.read()
        _, code, usage = os.wait4(contender.pid, 0)
    except BaseException:
        contender.kill()
        raise
    if code:
        sys.exit(f"{name} ended with code {code}:\n{said}")
    if bag is None:
        count = int(re.search(r"(\d+) messages", said)[1])
    else:
        with next(bag.glob("*.mcap")).open("rb") as file:
            count = make_reader(file).get_summary().statistics.message_count
    return count, usage.ru_utime + usage.ru_stime


def contenders(folder):
    """Return command and bag of each contender by name."""
    names = ", ".join(f"'{topic}'" for topic in TOPICS)
    recorder = f"{get_package_prefix('trackvib_sim')}/lib/trackvib_sim/recorder"
    found = {}
    for compression in ("zstd", "none"):
        bag = folder / compression
        given = ["-p", f"bag:={bag}", "-p", f"topics:=[{names}]"]
        found[f"recorder, {compression}"] = [recorder, "--ros-args", *given], bag
    found["count only"] = [sys.executable, __file__, "--role", "count"], None
    ros2 = shutil.which("ros2")
    if ros2 and subprocess.run([ros2, "bag", "record", "--help"], capture_output=True).returncode == 0:
        bag = folder / "ros2_bag"
        found["ros2 bag record"] = [ros2, "bag", "record", "-s", "mcap", "-o", str(bag), *TOPICS], bag
    return found


@click.command(help=__doc__.splitlines()[0])
@click.option("--rate", type=click.IntRange(1000), default=20_000, show_default=True, help="Messages a second.")
@click.option("--seconds", type=click.IntRange(1), default=60, show_default=True)
@click.option("--role", type=click.Choice(ROLES), default=None, hidden=True)
def main(rate, seconds, role):
    if role == "publish":
        return publish(rate, seconds)
    if role == "count":
        sys.exit(run_node(Counter, []))
    print(machine())
    sent = rate // len(TOPICS) * len(TOPICS) * seconds
    table = Table(title=f"{rate} messages/s for {seconds} s", title_justify="left")
    for column in ("", "lost", "CPU, us a message", "cores"):
        table.add_column(column, justify="right" if column else "left")
    lost = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (command, bag) in contenders(Path(folder)).items():
            count, cpu = measure(name, command, bag, rate, seconds)
            lost[name] = sent - count
            table.add_row(name, f"{lost[name]}", f"{1e6 * cpu / sent:.1f}", f"{cpu / seconds:.2f}")
    Console().print(table)
    if any(count for name, count in lost.items() if name.startswith("recorder")):
        sys.exit("the recorder loses messages")


if __name__ == "__main__":
    main()
