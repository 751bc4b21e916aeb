"""Nodes, and what they have in common."""

import tempfile
from pathlib import Path

import yaml
from launch import LaunchError
from launch.actions import Action, ExecuteProcess

from environment.ros2_stand_in.programs import find_executable
from environment.ros2_stand_in.terminal import Failure
from launch_ros.parameter_descriptions import ParameterFile, value_of


class PushRosNamespace(Action):
    """Puts nodes that follow into a namespace."""

    def __init__(self, namespace, **kwargs):
        super().__init__(**kwargs)
        self._namespace = namespace

    def execute(self, context):
        """Note it for them."""
        context.namespace = _joined(context.namespace, context.perform_substitution(self._namespace))


class SetParameter(Action):
    """Gives nodes that follow a parameter."""

    def __init__(self, name, value, **kwargs):
        super().__init__(**kwargs)
        self._name, self._value = name, value

    def execute(self, context):
        """Note it for them."""
        context.parameters.append({self._name: self._value})


class Node(ExecuteProcess):
    """An executable of a package as a node, with its name, namespace, parameters and remappings."""

    def __init__(
        self, *, executable, package=None, name=None, namespace=None, parameters=(), remappings=(), arguments=(),
        ros_arguments=(), **kwargs,
    ):  # fmt: skip
        super().__init__(cmd=[], name=executable, **kwargs)
        self._package, self._executable, self._node_name, self._namespace = package, executable, name, namespace
        self._parameters, self._remappings = list(parameters or ()), list(remappings or ())
        self._arguments, self._ros_arguments = list(arguments or ()), list(ros_arguments or ())

    def command(self, context):
        """Return the words of the command."""
        text = context.perform_substitution
        program = text(self._executable)
        if self._package is not None:
            try:
                program = find_executable(text(self._package), program)
            except Failure as failure:
                raise LaunchError(failure) from None
        words = [program, *map(text, self._arguments), "--ros-args", *map(text, self._ros_arguments)]
        name = text(self._node_name) if self._node_name is not None else None
        namespace = _joined(context.namespace, text(self._namespace) if self._namespace is not None else "")
        words += ["-r", f"__node:={name}"] if name else []
        words += ["-r", f"__ns:={namespace}"] if namespace else []
        for each in [*context.parameters, *self._parameters]:
            words += ["--params-file", self._parameter_file(each, f"{namespace}/{name}" if name else "/**", context)]
        for old, new in self._remappings:
            words += ["-r", f"{text(old)}:={text(new)}"]
        return words

    @staticmethod
    def _parameter_file(each, node, context):
        if isinstance(each, ParameterFile):
            return context.perform_substitution(each.param_file)
        if not isinstance(each, dict):
            return str(context.perform_substitution(each))
        values = {context.perform_substitution(name): value_of(value, context) for name, value in each.items()}
        with tempfile.NamedTemporaryFile("w", prefix="launch_params_", suffix=".yaml", delete=False) as file:
            yaml.safe_dump({node: {"ros__parameters": values}}, file)
        context.processes.leave(Path(file.name))
        return file.name


def _joined(outer, inner):
    return inner.rstrip("/") if inner.startswith("/") else f"{outer}/{inner}".rstrip("/")
