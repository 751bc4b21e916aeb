"""Definitions of the installed messages, as `cdr` wants them."""

from functools import cache
from importlib import import_module

from rosidl_parser.definition import (
    AbstractNestedType,
    AbstractString,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
)

from .cdr import LayoutError
from .field_kinds import NUMBERS, TEXT, Fields, Repeated


@cache
def installed_definition(message_type):
    """Return the `cdr.Fields` of an installed message class.

    Raises
    ------
    LayoutError
        It has a field of a kind that has no layout: a text of wide characters.
    """
    names = message_type.get_fields_and_field_types()
    return Fields((name, _kind(name, each)) for name, each in zip(names, message_type.SLOT_TYPES, strict=True))


def _kind(name, each):
    if isinstance(each, AbstractNestedType):
        count = each.size if isinstance(each, Array) else None
        most = each.maximum_size if isinstance(each, BoundedSequence) else None
        return Repeated(_kind(name, each.value_type), count, most)
    if isinstance(each, NamespacedType):
        return installed_definition(getattr(import_module(".".join(each.namespaces)), each.name))
    if isinstance(each, AbstractString):
        return TEXT
    if isinstance(each, BasicType) and each.typename in NUMBERS:
        return NUMBERS[each.typename]
    raise LayoutError(f"field {name} is a {getattr(each, 'typename', type(each).__name__)}, which has no layout")
