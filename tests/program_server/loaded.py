"""Preloaded by the tests' server of programs: nodes, what verbs have in common, and the compiled kernels."""

import gc
from importlib import import_module

import trackvib_sim.commands.analyze
import trackvib_sim.commands.replay_verify
import trackvib_sim.commands.run
import trackvib_sim.commands.run_summary  # noqa: F401
from trackvib_sim.compile_kernels import main as load_kernels
from trackvib_sim.nodes.forked_node import MODULES

load_kernels()
for module in MODULES.values():
    import_module(module)
gc.freeze()  # so that what is shared with the forked stays shared
