"""Property: a forked process that is asked to end before it has begun ends without a word; none comes after ROS 2."""

import signal
import subprocess
import sys

import pytest

pytestmark = pytest.mark.property

_PROGRAM = """
import os, signal, sys, time
from trackvib_sim.nodes.forked_node import begin_program, fork

def interrupt(*_):
    raise KeyboardInterrupt

def late(begun, asked):
    os.write(begun, b".")
    os.read(asked, 1)
    begin_program("late")
    signal.pause()

number = int(sys.argv[1])
signal.signal(number, interrupt)  # as the command line has it
(here, begun), (asked, there) = os.pipe(), os.pipe()
process = fork(late, begun, asked)
os.read(here, 1)
os.kill(process.pid, number)
os.write(there, b".")
process.join()
print(process.exitcode)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_before_the_begin_ends_it_silently(number):
    """By the signal itself, not by the handler of the process that it was forked from."""
    command = [sys.executable, "-c", _PROGRAM, str(int(number))]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == (f"{-number}\n", "")


def test_a_node_is_forked_before_ros_is_started():
    """Threads of ROS 2 would not come along."""
    program = "import rclpy, trackvib_sim.nodes.forked_node as f; rclpy.init(); f.ForkedNode('recorder')"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == "RuntimeError: node 'recorder' must be forked before ROS 2 is started"
