"""What the nodes of one namespace are given, by parameter files and one by one, as one file for all of them.

ROS itself reads several files and options in an order of its own: there a value for all nodes (`/**`) can count more
than a later one for a node by its name. Here what comes later counts.
"""

import yaml
from mr_mount_controller.node_base.parameter_files import is_for, is_wildcard, of_no_node, sections
from mr_mount_controller.node_base.parameters import ParameterError

from ..yaml_text import YamlTextError, load, read_text

_WHAT = "parameter file"
_SCALARS = (bool, int, float, str)


class NodeParameters:
    """Values by node and name.

    Parameters
    ----------
    nodes : iterable of str
        Their names.
    namespace : str
        Full name of their namespace.

    Attributes
    ----------
    notes : list of str
        On sections of the files that are for none of the nodes.
    """

    def __init__(self, nodes, namespace="/"):
        self.namespace, self.notes = namespace, []
        self._values = {node: {} for node in nodes}
        self._by_wildcard = {node: set() for node in nodes}

    def read(self, path):
        """Take what a parameter file gives to the nodes, section by section.

        Raises
        ------
        ParameterError
            The file cannot be read, is not a parameter file of ROS 2, or no section of it is for any of the nodes.
        """
        name = f"{_WHAT} {str(path)!r}"
        try:
            tree = load(read_text(path, _WHAT), name)
        except YamlTextError as error:
            raise ParameterError(str(error)) from None
        found = list(sections(tree)) if isinstance(tree, dict) else []
        if not found:
            raise ParameterError(f"{name} has no section, accepted: 'NODE: ros__parameters: NAME: VALUE'")
        for section, values in found:
            for parameter, value in values.items():
                if not _is_value(value):
                    raise ParameterError(
                        f"{name}: {parameter} of {section} is {value!r}, accepted: a number, a text in quotes, true, "
                        "false, or a list of one of these"
                    )
            for node in self._values:
                if is_for(section, self._full_name(node)):
                    self._give(node, values, is_wildcard(section))
        self._look_for_idle(name, [section for section, _ in found])

    def _look_for_idle(self, name, found):
        nodes = [self._full_name(node) for node in self._values]
        idle = [section for section in found if not any(is_for(section, node) for node in nodes)]
        if idle:
            words = of_no_node(name, idle, nodes)
            if idle == found:
                raise ParameterError(words)
            self.notes.append(words)

    def give(self, node, **values):
        """Give values to a node by its name."""
        self._give(node, values, by_wildcard=False)

    def get(self, node, parameter, default=None):
        """Return what a node is given, or else the default."""
        return self._values[node].get(parameter, default)

    def write(self, path):
        """Write all as one parameter file; what came by wildcards stays in sections with such."""
        tree = {}
        for node, values in self._values.items():
            for name, parameter in ((f"/**/{node}", True), (self._full_name(node), False)):
                part = {key: value for key, value in values.items() if (key in self._by_wildcard[node]) is parameter}
                if part:
                    tree[name] = {"ros__parameters": part}
        path.write_text(yaml.dump(tree, Dumper=_Dumper, sort_keys=False, allow_unicode=True), encoding="utf-8")

    def _full_name(self, node):
        return f"{self.namespace.rstrip('/')}/{node}"

    def _give(self, node, values, by_wildcard):
        self._values[node] |= values
        if by_wildcard:
            self._by_wildcard[node] |= values.keys()
        else:
            self._by_wildcard[node] -= values.keys()


class _Dumper(yaml.SafeDumper):
    """PyYAML's safe one, but without aliases, which ROS 2 does not take."""

    def ignore_aliases(self, data):
        return True


def _is_value(value):
    if isinstance(value, list):
        return all(type(each) in _SCALARS for each in value)
    return type(value) in _SCALARS
