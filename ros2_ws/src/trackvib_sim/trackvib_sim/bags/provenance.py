"""What made a bag, as it stands in the bag: as metadata records for programs, as attachments for people."""

from mr_mount_controller.node_base.parameters import ParameterError

from ..numerics.units import NANO
from .metadata import to_yaml
from .versions import versions

PARAMETERS_OF = "parameters of "  # and a node's full name
_VALUES = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}  # rcl_interfaces/ParameterType


def write_versions(bag):
    """Write down in a `BagWriter` which software is at work."""
    bag.add_provenance("versions", versions())
    bag.add_attachment("versions.yaml", to_yaml(versions()))


def write_parameters(bag, node, parameters):
    """Write down in a `BagWriter` the parameters of a node by its full name: values by name, None if it tells none."""
    if parameters is not None:
        bag.add_attachment(f"parameters{node}.yaml", _parameter_file(node, parameters))
    bag.add_provenance(f"{PARAMETERS_OF}{node}", {"": "not told"} if parameters is None else parameters)


def parameters(provenance):
    """Return what a bag's metadata records tell of nodes: full name -> parameters, as text."""
    return {
        record.removeprefix(PARAMETERS_OF): values
        for record, values in provenance.items()
        if record.startswith(PARAMETERS_OF)
    }


def parameters_with(provenance, name):
    """Return name and parameters, as text, of the node that has a parameter of that name; "" and {} if none is told.

    Nodes are found by what they have because they can be named as one likes.
    """
    return next(((node, values) for node, values in parameters(provenance).items() if name in values), ("", {}))


def recorded_value(parameter, recorded):
    """Return what was recorded as text, in the type of the `Parameter`; one younger than the bag has its default.

    Raises
    ------
    ParameterError
        It cannot be used.
    """
    text = recorded.get(parameter.name, str(parameter.default))
    kind = type(parameter.default)
    try:
        return parameter.check(text == "True" if kind is bool else kind(text))
    except ValueError as error:
        raise ParameterError(f"recorded {parameter.name} is {text!r}: {error}") from None


def recorded_law(recording, name, law):
    """Return values by name of a law's parameters and their changes, as recorded; none if the run had another law."""
    _, recorded = parameters_with(recording.provenance, "law")
    if recorded.get("law") != name:
        return {}, ()
    return {each.name: recorded_value(each, recorded) for each in law.parameters}, recording.law_changes


def law_change(message):
    """Return stamp [ns] and new values by name that a message on `law_parameters` tells."""
    values = {each.name: getattr(each.value, _VALUES[each.value.type]) for each in message.changed_parameters
              if each.value.type in _VALUES}  # fmt: skip
    return message.stamp.sec * NANO + message.stamp.nanosec, values


def _parameter_file(node, parameters):
    """Return the text of a file that `--params-file` takes to start a node with the same parameters."""
    # of an empty list nobody can tell which type of list it is, ROS 2 neither
    known = {key: list(value) if hasattr(value, "tolist") else value for key, value in parameters.items()}
    return to_yaml({node: {"ros__parameters": {key: value for key, value in known.items() if value not in ([], None)}}})
