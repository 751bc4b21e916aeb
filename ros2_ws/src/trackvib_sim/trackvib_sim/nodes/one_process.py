"""Simulator, road and controller in one process, on one executor: the same nodes and messages without switching."""

import sys

from mr_mount_controller.node import ControllerNode
from mr_mount_controller.node_base.node_process import run_node

from .road_excitation import RoadExcitationNode
from .simulator import SimulatorNode


def main(args=None):
    """Run the simulator; the two others answer while it waits."""
    sys.exit(run_node(SimulatorNode, args, companions=(RoadExcitationNode, ControllerNode)))
