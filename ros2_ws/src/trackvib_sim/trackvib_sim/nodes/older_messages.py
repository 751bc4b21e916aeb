"""Messages of a bag whose type has changed since, as the installed type has them."""

from importlib import import_module

from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.definitions import installed_definition
from rclpy.serialization import serialize_message
from rosbags.serde import SerdeError
from rosidl_parser.definition import AbstractNestedType, NamespacedType

from ..bags.definitions import Definition, UnreadableDefinition


def renewal(schema, kind):
    """Return what makes, of a message's bytes in a bag, those of the installed type `kind`; None if they are the same.

    Fields are known by their names; those that the bag does not have stay at their defaults. `schema` is mcap's, of the
    bag. What is returned raises `LayoutError` where a message does not fit.

    Raises
    ------
    UnreadableDefinition
        The bag's definition is none.
    """
    if not schema.data.strip():  # not told
        return None
    try:
        definition, installed = Definition(schema.name, schema.encoding, schema.data), installed_definition(kind)
    except UnreadableDefinition:
        raise
    except LayoutError:  # nobody can tell
        return None
    if definition.kind == installed:
        return None
    return lambda data: _renewed(definition, kind, data)


def _renewed(definition, kind, data):
    try:
        return serialize_message(_copied(definition.message(data), kind))
    except LayoutError:
        raise
    except (SerdeError, AssertionError, TypeError, ValueError, OverflowError) as error:
        raise LayoutError(f"message does not fit the installed type: {error}") from None


def _copied(source, kind):
    """Return a message of a type with the values of another one's fields."""
    message = kind()
    for name, slot in zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True):
        if hasattr(source, name):
            setattr(message, name, _value(getattr(source, name), slot))
    return message


def _value(value, slot):
    if isinstance(slot, AbstractNestedType):
        return [_value(each, slot.value_type) for each in (value.tolist() if hasattr(value, "tolist") else value)]
    if isinstance(slot, NamespacedType):
        return _copied(value, getattr(import_module(".".join(slot.namespaces)), slot.name))
    return value
