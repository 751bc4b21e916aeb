"""`ros2 param list`, `get`, `set`, `describe` and `dump`."""

import sys

from rcl_interfaces.msg import ParameterType
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient

from environment.ros2_stand_in.message_text import from_yaml, to_yaml
from environment.ros2_stand_in.session import Session, absolute, is_hidden
from environment.ros2_stand_in.terminal import Failure, complain, line, lines

_ANSWER = 5.0  # s for a node's answer
_TYPES = {
    ParameterType.PARAMETER_NOT_SET: ("not set", "Parameter not set."),
    ParameterType.PARAMETER_BOOL: ("boolean", "Boolean value is:"),
    ParameterType.PARAMETER_INTEGER: ("integer", "Integer value is:"),
    ParameterType.PARAMETER_DOUBLE: ("double", "Double value is:"),
    ParameterType.PARAMETER_STRING: ("string", "String value is:"),
    ParameterType.PARAMETER_BYTE_ARRAY: ("byte array", "Byte values are:"),
    ParameterType.PARAMETER_BOOL_ARRAY: ("boolean array", "Boolean values are:"),
    ParameterType.PARAMETER_INTEGER_ARRAY: ("integer array", "Integer values are:"),
    ParameterType.PARAMETER_DOUBLE_ARRAY: ("double array", "Double values are:"),
    ParameterType.PARAMETER_STRING_ARRAY: ("string array", "String values are:"),
}


class _Node:
    """The parameters of a node by its full name."""

    def __init__(self, session, name):
        self._session, self._name = session, name
        self._client = AsyncParameterClient(session.node, name)

    def names(self, prefixes=()):
        """Return the names of all, sorted, or of those below some prefixes."""
        return sorted(self._answer(self._client.list_parameters(list(prefixes) or None)).result.names)

    def values(self, names):
        """Return a `rcl_interfaces/msg/ParameterValue` for each name; none at all if one is not known."""
        return self._answer(self._client.get_parameters(list(names))).values

    def descriptors(self, names):
        """Return what the node says of each."""
        return self._answer(self._client.describe_parameters(list(names))).descriptors

    def set(self, parameter):
        """Ask for a change; returns the node's `rcl_interfaces/msg/SetParametersResult`."""
        return self._answer(self._client.set_parameters([parameter])).results[0]

    def _answer(self, future):
        if not self._session.wait_until(future.done, _ANSWER):
            raise Failure(f"Wait for service timed out waiting for parameter services for node {self._name}")
        return future.result()


def list_parameters(chosen):
    """Print names by node, or those of one node."""
    with Session() as session:
        session.settle(chosen.spin_time)
        hidden, names = chosen.include_hidden_nodes, sorted(set(session.node_names()))
        if chosen.node_name:
            names = [session.require_node(chosen.node_name, 0.0)]
        for name in names if chosen.node_name else [each for each in names if hidden or not is_hidden(each)]:
            node = _Node(session, name)
            try:
                found = node.names(chosen.param_prefixes)
            except Failure as failure:
                if chosen.node_name:
                    raise
                complain(failure, 1)
                continue
            if found and not chosen.node_name:
                line(f"{name}:")
            types = node.descriptors(found) if chosen.param_type else [None] * len(found)
            for each, descriptor in zip(found, types, strict=True):
                line(f"  {each} (type: {_TYPES[descriptor.type][0]})" if descriptor else f"  {each}")


def get(chosen):
    """Print a value."""
    with Session() as session:
        values = _there(session, chosen).values([chosen.parameter_name])
    if not values or values[0].type == ParameterType.PARAMETER_NOT_SET:
        raise Failure("Parameter not set")
    value = parameter_value_to_python(values[0])
    value = value.tolist() if hasattr(value, "tolist") else value
    line(value if chosen.hide_type else f"{_TYPES[values[0].type][1]} {value}")


def set_one(chosen):
    """Change a value; says why where the node refuses."""
    value = from_yaml(chosen.value, "the value")
    try:
        parameter = Parameter(chosen.parameter_name, value=value)
    except TypeError:  # a mapping, a date, a list of several kinds: a text, as ros2cli takes it
        parameter = Parameter(chosen.parameter_name, value=chosen.value)
    with Session() as session:
        result = _there(session, chosen).set(parameter.to_parameter_msg())
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        line(f"Set parameter successful{reason}")
        return 0
    line(f"Setting parameter failed{reason}", sys.stderr)
    return 1


def describe(chosen):
    """Print type, meaning and range."""
    with Session() as session:
        node = _there(session, chosen)
        unknown = sorted(set(chosen.parameter_names) - set(node.names()))
        if unknown:
            raise Failure(f"Parameter not set: {', '.join(unknown)}")
        found = node.descriptors(chosen.parameter_names)
    for each in found:
        line(f"Parameter name: {each.name}")
        line(f"  Type: {_TYPES[each.type][0]}")
        if each.description:
            line(f"  Description: {each.description}")
        line("  Constraints:")
        if each.read_only:
            line("    Read only: true")
        for limits in [*each.floating_point_range, *each.integer_range]:
            line(f"    Min value: {limits.from_value}")
            line(f"    Max value: {limits.to_value}")
            if limits.step:
                line(f"    Step: {limits.step}")
        if each.additional_constraints:
            line(f"    Additional constraints: {each.additional_constraints}")


def dump(chosen):
    """Print all values of a node as a parameter file."""
    with Session() as session:
        node = _there(session, chosen)
        names = node.names()
        values = node.values(names)
    tree = {}
    for name, value in zip(names, map(parameter_value_to_python, values), strict=True):
        *above, last = name.split(".")
        inner = tree
        for each in above:
            inner = inner.setdefault(each, {})
        inner[last] = value.tolist() if hasattr(value, "tolist") else value
    lines(to_yaml({absolute(chosen.node_name): {"ros__parameters": tree}}))


def _there(session, chosen):
    return _Node(session, session.require_node(chosen.node_name, chosen.timeout))
