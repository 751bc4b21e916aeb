"""Message definitions of a bag, as `node_base.field_kinds` has them; and whole messages by them."""

import re
from functools import cache

from mr_mount_controller.node_base.cdr import LayoutError, check
from mr_mount_controller.node_base.field_kinds import NUMBERS, TEXT, Fields, Repeated
from mr_mount_controller.node_base.plain_text import shortened
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.base import TypesysError

_IDL_SECTION = re.compile(r"^={80}\s*\nIDL: .*$", re.MULTILINE)  # before each file of several


def _types_from_idl(text, _):
    types = {}
    for section in filter(str.strip, _IDL_SECTION.split(text)):
        types |= get_types_from_idl(section)
    return types


_PARSERS = {"ros2msg": get_types_from_msg, "ros2idl": _types_from_idl}
_DEPTH = 50  # of messages within messages; one that holds itself has no end


class UnreadableDefinition(LayoutError):
    """A definition that is none, or in an encoding that is not known."""


class Definition:
    """A message type (`package/msg/Type`) as a bag defines it.

    Some recorders leave definitions out: what a bag does not define of the types that come with ROS 2 is as there.

    Attributes
    ----------
    kind : cdr.Fields

    Raises
    ------
    UnreadableDefinition
        The schema's encoding is unknown, or its text is no definition.
    LayoutError
        The definition is incomplete, or has a field without layout.
    """

    def __init__(self, type_name, encoding, text):
        self._type_name, self._store, self._known = type_name, get_typestore(Stores.EMPTY), {}
        types = _parsed(type_name, encoding, text)
        try:
            self._store.register(types | _lacking(types, type_name))
        except (TypesysError, ValueError, LookupError) as error:
            raise UnreadableDefinition(f"definition of {type_name} cannot be read: {error}") from None
        if type_name not in self._store.fielddefs:
            raise UnreadableDefinition(f"definition of {type_name} is missing, and the type is not a well-known one")
        self.kind = self._kind((Nodetype.NAME, type_name), "", _DEPTH)

    def message(self, data):
        """Return a serialised message as an object with its fields; `LayoutError` if it does not fit."""
        check(self.kind, data)
        return self._store.deserialize_cdr(data, self._type_name)

    def _kind(self, description, name, depth):
        node, detail = description
        if depth == 0:
            raise LayoutError(f"definition of {self._type_name} is more than {_DEPTH} deep")
        if node == Nodetype.NAME:
            if detail not in self._store.fielddefs:
                raise LayoutError(f"field {name} is a {detail}, which the definition does not define")
            if detail not in self._known:
                fields = self._store.fielddefs[detail][1]
                self._known[detail] = Fields([(each, self._kind(inner, each, depth - 1)) for each, inner in fields])
            return self._known[detail]
        if node != Nodetype.BASE:
            inner, count = detail
            kind = self._kind(inner, name, depth)
            return Repeated(kind, count) if node == Nodetype.ARRAY else Repeated(kind, most=count or None)
        if detail[0] == "string":
            return TEXT
        if detail[0] not in NUMBERS:
            raise LayoutError(f"field {name} is a {detail[0]}, which has no layout")
        return NUMBERS[detail[0]]


def _parsed(type_name, encoding, text):
    if not text.strip() and encoding in ("", *_PARSERS):  # not told
        return {}
    try:
        parse = _PARSERS[encoding]
    except KeyError:
        accepted = ", ".join(_PARSERS)
        raise UnreadableDefinition(f"schema of {type_name} is in {encoding!r}, accepted: {accepted}") from None
    try:
        return parse(text.decode().replace("\r\n", "\n"), type_name)
    except (TypesysError, ValueError, LookupError) as error:
        reason = shortened(" ".join(str(error).split()))  # the parser's own tells the whole text again
        raise UnreadableDefinition(f"definition of {type_name} cannot be read: {reason}") from None


@cache
def _well_known():
    """Return the types that come with ROS 2; loaded late, as most bags define all of theirs."""
    return get_typestore(Stores.ROS2_JAZZY).fielddefs


def _lacking(types, type_name):
    """Return the well-known types that a type is made of, itself included, and that are not among the given ones."""
    found, seen, names = {}, set(), [type_name]
    while names:
        name = names.pop()
        if name in seen or (name not in types and name not in _well_known()):
            continue
        seen.add(name)
        if name not in types:
            found[name] = _well_known()[name]
        names += [inner for _, description in (types.get(name) or found[name])[1] for inner in _named(description)]
    return found


def _named(description):
    """Yield the name of the message that a field holds, if it does."""
    node, detail = description
    if node == Nodetype.NAME:
        yield detail
    elif node != Nodetype.BASE:
        yield from _named(detail[0])
