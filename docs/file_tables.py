"""The tables of the documents about files that users write: every item with its meaning, from the files' schemas."""

from functools import partial

from mr_mount_controller.node_base.plain_text import number
from trackvib_sim.road_sources.road_file import RoadFile
from trackvib_sim.studies.calibration.plan import Plan
from trackvib_sim.vehicle.drive.drive_file import DriveFile
from trackvib_sim.vehicle.parameters import Vehicle

HEAD = ("item", "meaning", "unit", "accepted", "default")
_BOUNDS = {"exclusiveMinimum": "above", "minimum": "from", "exclusiveMaximum": "below", "maximum": "up to"}
_NOTHING = ("", "", "")  # unit, accepted and default of a section


def items_of_file(model):
    """Every item that a file can have, section by section, from its schema (a pydantic model)."""
    schema = model.model_json_schema(by_alias=True)
    known, told = schema["$defs"], set()
    rows = [_row(schema, item) for item in schema["properties"].items() if not _section_of(item[1], known)]
    rows = [HEAD, *(row for row in rows if row)]
    for name, section in schema["properties"].items():
        if "patternProperties" in section:
            (section,) = section["patternProperties"].values()
            name = f"{name}.NAME"
        for kind in _kinds(section.get("items", section), known):
            if "properties" not in kind:
                continue
            words = " ".join(kind["description"].partition("\n\n")[0].split())
            if kind["title"] in told:
                rows.append((f"**{name}**", f"{words} Items as above.", *_NOTHING))
                continue
            told.add(kind["title"])
            rows += [(f"**{name}**", words, *_NOTHING), *map(partial(_row, kind), kind["properties"].items())]
    return rows


def _section_of(section, known):
    """Whether a property is a section with items, or several of them."""
    inner = next(iter(section["patternProperties"].values())) if "patternProperties" in section else section
    return any(
        "properties" in kind and "value" not in kind["properties"] for kind in _kinds(inner.get("items", inner), known)
    )


def _kinds(section, known):
    """The sections that one can be, without references and without none."""
    for each in section.get("oneOf") or section.get("anyOf") or [section]:
        if "$ref" in each:
            yield known[each["$ref"].rpartition("/")[2]]
        elif "oneOf" in each or "anyOf" in each:
            yield from _kinds(each, known)
        elif each.get("type") != "null":
            yield each


def _row(kind, item):
    name, section = item
    (inner,) = (each for each in section.get("anyOf", [section]) if each.get("type") != "null")
    quantity = inner.get("properties", {}).get("value")
    unit = inner["properties"]["unit"]["const"] if quantity else inner.get("unit", "")
    default = "" if name in kind.get("required", ()) else _default(section.get("default"))
    return f"`{name}`", section["description"], unit, _accepted(quantity or inner), default


def _default(value):
    """The value of an item that is left out; none where the meaning tells what then holds."""
    if value is None:
        return "none"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return number(value) if isinstance(value, (int, float)) else f"`{value}`"


def _accepted(schema):
    """What a value may be, in words."""
    if "anyOf" in schema:
        return ", or ".join(map(_accepted, schema["anyOf"]))
    if "const" in schema or "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema.get("enum", [schema.get("const")]))
    if "prefixItems" in schema:
        return f"[{', '.join(map(_accepted, schema['prefixItems']))}]"
    if schema.get("type") == "array":
        low, high = schema.get("minItems", 0), schema.get("maxItems")
        size = f"{low}" if low == high else f"{low} to {high}" if high else f"{low} or more"
        return f"list of {size}, each {_accepted(schema['items'])}"
    if schema.get("type") == "boolean":
        return "`true`, `false`"
    if schema.get("type") == "string":
        return "a name of lower-case letters, digits and underscores" if "pattern" in schema else "text"
    bounds = [f"{word} {number(schema[key])}" for key, word in _BOUNDS.items() if key in schema]
    whole = "multipleOf" in schema or schema.get("type") == "integer"
    return " ".join(["a whole number" if whole else "a number", *bounds])


TABLES = {
    f"items of a {name} file": partial(items_of_file, model)
    for name, model in (("vehicle", Vehicle), ("road", RoadFile), ("drive", DriveFile), ("plan", Plan))
}
