"""The part of ROS 2's `launch` that launch files of nodes use, under the same names."""

import importlib.util

__all__ = ["LaunchContext", "LaunchDescription", "LaunchDescriptionEntity", "LaunchError", "load_description"]


class LaunchError(Exception):
    """A launch file that cannot be run; the message says why."""


class LaunchDescriptionEntity:
    """Whatever a description holds."""

    def visit(self, context):
        """Do it, or nothing."""
        raise NotImplementedError


class LaunchDescription(LaunchDescriptionEntity):
    """Entities in the order in which they are visited."""

    def __init__(self, entities=()):
        self.entities = list(entities)

    def add_action(self, action):
        """Put one at the end."""
        self.entities.append(action)

    def visit(self, context):
        """Visit all of them."""
        for entity in self.entities:
            context.visit(entity)


class LaunchContext:
    """What is known while a description is visited.

    Attributes
    ----------
    launch_configurations : dict
        Values of arguments by name.
    namespace : str
        Of nodes, as pushed.
    parameters : list
        Parameters that every node gets.
    environment : dict
        Variables that processes get beside those of this one.
    processes : processes.Processes
    """

    def __init__(self, launch_configurations, processes):
        self.launch_configurations, self.processes = dict(launch_configurations), processes
        self.namespace, self.parameters, self.environment = "", [], {}
        self.handlers = []

    def visit(self, entity):
        """Visit an entity, or each of some."""
        if entity is None:
            return
        if isinstance(entity, (list, tuple)):
            for each in entity:
                self.visit(each)
        elif isinstance(entity, LaunchDescriptionEntity):
            entity.visit(self)
        else:
            raise LaunchError(f"{entity!r} cannot be part of a launch description")

    def perform_substitution(self, value):
        """Return the text that a substitution, a text, or a list of both stands for."""
        if isinstance(value, (list, tuple)):
            return "".join(map(self.perform_substitution, value))
        return value.perform(self) if hasattr(value, "perform") else str(value)


def load_description(path):
    """Return the `LaunchDescription` of a launch file in Python.

    Raises
    ------
    LaunchError
        It cannot be loaded.
    """
    try:
        spec = importlib.util.spec_from_file_location("launch_file", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.generate_launch_description()
    except ImportError as error:
        raise LaunchError(f"{path}: {error}; trackvib's stand-in supports only a part of ROS 2's launch") from None
    except Exception as error:  # whatever a user's file raises
        raise LaunchError(f"{path}: {type(error).__name__}: {error}") from None
