"""Preloaded by the tests' server of nodes: the modules of all nodes and their compiled kernels."""

import gc

import trackvib_sim.nodes.one_process
import trackvib_sim.nodes.player
import trackvib_sim.nodes.recorder  # noqa: F401
from trackvib_sim.compile_kernels import main as load_kernels

load_kernels()
gc.freeze()  # so that what is shared with the forked stays shared
