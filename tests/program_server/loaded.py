"""Preloaded by the tests' server of programs: what nodes and verbs have in common, and the compiled kernels.

ROS 2 is not: libraries of it start threads, which do not come along into forked processes, and end them later.
"""

import gc
import sys

import trackvib_sim.commands.analyze
import trackvib_sim.commands.replay_verify
import trackvib_sim.commands.run
import trackvib_sim.commands.run_summary  # noqa: F401
from trackvib_sim.compile_kernels import main as load_kernels

load_kernels()
gc.freeze()  # so that what is shared with the forked stays shared
assert "rclpy" not in sys.modules
