"""Asks other nodes for their parameters, for whoever writes down what made a bag."""

from mr_mount_controller.node_base.taken_up import taken_up
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient

_TIMEOUT = 2.0  # s, for a node to tell its parameters


def parameters_of(node, name):
    """Ask a node for its parameters; returns values by name, None if it does not tell (or is no ROS 2 node)."""
    client = AsyncParameterClient(node, name)
    node.spin_until(taken_up(node))
    names = _result(node, client.list_parameters())
    if names is None:
        return None
    names = sorted(names.result.names)
    values = _result(node, client.get_parameters(names))
    return dict(zip(names, map(parameter_value_to_python, values.values), strict=True)) if values else {}


def _result(node, future):
    return future.result() if node.spin_until(future.done, _TIMEOUT) else None
