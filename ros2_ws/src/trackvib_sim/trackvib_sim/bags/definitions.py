"""Message definitions of a bag, as `node_base.cdr` wants them; and whole messages by them."""

from mr_mount_controller.node_base.cdr import NUMBERS, TEXT, Fields, LayoutError, Repeated, check
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.base import TypesysError

_PARSERS = {"ros2msg": get_types_from_msg, "ros2idl": lambda text, _: get_types_from_idl(text)}
_DEPTH = 50  # of messages within messages; one that holds itself has no end


class Definition:
    """A message type (`package/msg/Type`) as a bag defines it.

    Attributes
    ----------
    kind : cdr.Fields

    Raises
    ------
    LayoutError
        The schema's encoding is unknown, its text is no definition or an incomplete one, or has a field without layout.
    """

    def __init__(self, type_name, encoding, text):
        try:
            parse = _PARSERS[encoding]
        except KeyError:
            accepted = ", ".join(_PARSERS)
            raise LayoutError(f"schema of {type_name} is in {encoding!r}, accepted are {accepted}") from None
        self._type_name, self._store, self._known = type_name, get_typestore(Stores.EMPTY), {}
        try:
            self._store.register(parse(text.decode(), type_name))
        except (TypesysError, ValueError, LookupError) as error:
            raise LayoutError(f"definition of {type_name} cannot be read: {error}") from None
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
