"""Quantities of a vehicle file: each carries value, unit and source, and is checked before its plain value is used."""

from dataclasses import dataclass
from typing import Annotated, Literal

from mr_mount_controller.node_base.plain_text import number, span
from pydantic import AfterValidator, BeforeValidator, Field
from pydantic_core import core_schema

SOURCES = ("published", "literature", "assumed", "calibrated")
KEYS = {"value", "unit", "source", "note"}
# beyond these, squares and differences of a vehicle's numbers lose their digits
LARGEST = 1e12
LARGEST_LENGTH = 20.0  # m; the longest tank has 16: what is more was most likely written in millimetres


@dataclass(frozen=True)
class _Quantity:
    """Makes a type that of a value written with unit and source: checks these, and hands on the bare value."""

    unit: str

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.no_info_before_validator_function(self._plain, handler(source))

    def __get_pydantic_json_schema__(self, schema, handler):
        return {
            "type": "object",
            "properties": {
                "value": handler(schema),
                "unit": {"const": self.unit},
                "source": {"enum": list(SOURCES)},
                "note": {"type": "string"},
            },
            "required": ["value", "unit", "source"],
            "additionalProperties": False,
            "if": {"properties": {"source": {"const": "literature"}}},
            "then": {"required": ["note"]},
        }

    def _plain(self, quantity):
        if not isinstance(quantity, dict) or not {"value", "unit", "source"} <= set(quantity) <= KEYS:
            raise ValueError(f"must be written {{value: ..., unit: {self.unit}, source: ...}}, optionally with a note")
        if quantity["unit"] != self.unit:
            raise ValueError(f"unit is {quantity['unit']!r}, must be {self.unit!r}")
        if quantity["source"] not in SOURCES:
            raise ValueError(f"source is {quantity['source']!r}, must be one of {', '.join(SOURCES)}")
        if quantity["source"] == "literature" and not quantity.get("note"):
            raise ValueError("source is 'literature', so a note must cite it")
        return quantity["value"]


def _no_truth(value):
    """Refuse truth values, of which pydantic would make numbers."""
    if any(isinstance(each, bool) for each in (value if isinstance(value, list) else [value])):
        raise ValueError(f"value is {value!r}, must be a number")
    return value


_NUMBERS = BeforeValidator(_no_truth)


def _bounded(unit):
    """Return a validator that refuses numbers that no vehicle has."""
    largest = LARGEST_LENGTH if unit == "m" else LARGEST

    def check(value):
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, list):
                check(each)
            elif abs(each) > largest:
                raise ValueError(f"value is {number(each)}, must be from {span(-largest, largest, unit)}")
        return value

    return AfterValidator(check)


def scalar(unit, **limits):
    """Return the type of a finite number in `unit` within pydantic's `limits` (gt, ge, lt, le)."""
    return Annotated[float, Field(allow_inf_nan=False, **limits), _NUMBERS, _bounded(unit), _Quantity(unit)]


def vector(unit, length=None, most=None, **limits):
    """Return the type of a list of finite numbers in `unit`, of a fixed length or of `most` numbers at most."""
    element = Annotated[float, Field(allow_inf_nan=False, **limits)]
    sized = Field(min_length=length or 1, max_length=length or most)
    return Annotated[list[element], sized, _NUMBERS, _bounded(unit), _Quantity(unit)]


def vectors(unit, length):
    """Return the type of a list of vectors of `length` numbers in `unit`."""
    element = Annotated[float, Field(allow_inf_nan=False)]
    row = Annotated[list[element], Field(min_length=length, max_length=length)]
    return Annotated[list[row], Field(min_length=1), _NUMBERS, _bounded(unit), _Quantity(unit)]


def choice(*words):
    """Return the type of one of some words; its unit is "-"."""
    return Annotated[Literal[words], _Quantity("-")]


def one_or_many(unit, most, **limits):
    """Return the type of a finite number in `unit`, or of a list of up to `most` of them."""
    element = Annotated[float, Field(allow_inf_nan=False, **limits)]
    many = Annotated[list[element], Field(min_length=1, max_length=most)]
    return Annotated[many, _listed(element, many), _NUMBERS, _bounded(unit), _Quantity(unit)]


def words(most, *known):
    """Return the type of one of some words, or of a list of up to `most` of them; its unit is "-"."""
    many = Annotated[list[Literal[known]], Field(min_length=1, max_length=most)]
    return Annotated[many, _listed(Literal[known], many), _Quantity("-")]


def _listed(one, many):
    """Return a validator that makes a list of one element."""
    return BeforeValidator(
        lambda value: value if isinstance(value, list) else [value], json_schema_input_type=one | many
    )
