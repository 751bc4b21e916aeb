"""The JSON Schema of vehicle files: it takes the shipped files as they are written, and refuses what readers refuse."""

import copy
import re

import pytest
import yaml
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.vehicle.parameters import Vehicle

pytestmark = pytest.mark.property
SCHEMA = Vehicle.model_json_schema()
TYPES = {"object": dict, "array": list, "string": str, "number": (int, float), "integer": int, "null": type(None)}
NOTES = {"title", "description", "default", "discriminator", "$defs"}


class Loader(yaml.SafeLoader):
    """YAML 1.2, as editors have it, takes 4.0e7 for a number; 1.1 does not."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?[0-9.]+e[-+]?[0-9]+$"), list("-+0123456789."))


def fits(value, schema):
    """Whether a value is valid by those rules of JSON Schema 2020-12 that this schema uses; others are an error."""
    for rule, argument in schema.items():
        if rule not in NOTES and not _holds(rule, argument, value, schema):
            return False
    return True


def _holds(rule, argument, value, schema):
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    whole, part = isinstance(value, dict), isinstance(value, list)
    checks = {
        "$ref": lambda: fits(value, SCHEMA["$defs"][argument.rpartition("/")[2]]),
        "type": lambda: isinstance(value, TYPES[argument]) and not isinstance(value, bool),
        "const": lambda: value == argument,
        "enum": lambda: value in argument,
        "anyOf": lambda: any(fits(value, each) for each in argument),
        "oneOf": lambda: sum(fits(value, each) for each in argument) == 1,
        "required": lambda: not whole or set(argument) <= set(value),
        "properties": lambda: not whole or all(fits(value[k], each) for k, each in argument.items() if k in value),
        "additionalProperties": lambda: argument is False and (not whole or set(value) <= set(schema["properties"])),
        "patternProperties": lambda: not whole or all(
            fits(each, rule) for k, each in value.items() for pattern, rule in argument.items() if re.search(pattern, k)
        ),
        "maxProperties": lambda: not whole or len(value) <= argument,
        "items": lambda: not part or all(fits(each, argument) for each in value),
        "minItems": lambda: not part or len(value) >= argument,
        "maxItems": lambda: not part or len(value) <= argument,
        "pattern": lambda: not isinstance(value, str) or bool(re.search(argument, value)),
        "maxLength": lambda: not isinstance(value, str) or len(value) <= argument,
        "minimum": lambda: not number or value >= argument,
        "maximum": lambda: not number or value <= argument,
        "exclusiveMinimum": lambda: not number or value > argument,
        "exclusiveMaximum": lambda: not number or value < argument,
        "multipleOf": lambda: not number or value % argument == 0,
        "if": lambda: not fits(value, argument) or fits(value, schema["then"]),
        "then": lambda: True,
    }  # fmt: skip
    return checks[rule]()


@pytest.fixture(scope="module", params=vehicle_names())
def content(request):
    """Each shipped file as an editor reads it."""
    return yaml.load(find_vehicle(request.param).read_text(encoding="utf-8"), Loader)  # noqa: S506, a safe one


def test_shipped_files_fit(content):
    """Every item is what the schema says."""
    assert fits(content, SCHEMA)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("format",), 4),
        (("hull", "mass"), 17.0),
        (("hull", "mass", "unit"), "t"),
        (("hull", "mass", "value"), -1.0),
        (("hull", "mass", "value"), "heavy"),
        (("hull", "mass", "source"), "guessed"),
        (("hull", "mass", "remark"), "unknown key"),
        (("hull", "colour"), {"value": 1.0, "unit": "m", "source": "assumed"}),
        (("hull", "centre", "value"), [0.0, 0.0]),
        (("coil", "model", "value"), "ideal"),
        (("tracks", "links", "value"), 100.5),
        (("tracks", "links", "value"), [100, 100, 100]),
        (("swing_arms", "direction", "value"), ["trailing", "sideways"]),
        (("powertrain", "hinge"), "loose"),
        (("ground", "friction"), {"value": 0.7, "unit": "-", "source": "literature"}),
    ],
    ids=lambda each: ".".join(each) if isinstance(each, tuple) else None,
)
def test_what_readers_refuse_does_not_fit(content, path, value):
    """A wrong item makes the file unfit for the schema and for the reader alike."""
    wrong = copy.deepcopy(content)
    section = wrong
    for name in path[:-1]:
        section = section[name]
    section[path[-1]] = value
    assert not fits(wrong, SCHEMA)
    with pytest.raises(ValueError, match="validation error"):
        Vehicle.model_validate(wrong)


def test_one_value_may_stand_for_a_list(content):
    """What goes by station or by side is one value or a list, for schema and reader."""
    for links in (100, [100, 101]):
        other = copy.deepcopy(content)
        other["tracks"]["links"]["value"] = links
        assert fits(other, SCHEMA)
        assert Vehicle.model_validate(other).tracks.links == [100, 100 if links == 100 else 101]
