"""The tables of the documents about vehicles: what a vehicle file holds, and what those that are shipped have in it."""

from functools import partial

from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.drawings.vehicle_table import Figure, Parameter, figures, parameters
from trackvib_sim.vehicle.parameters import Vehicle
from trackvib_sim.vehicle.vehicle_file import read_vehicle

_BOUNDS = {"exclusiveMinimum": "above", "minimum": "from", "exclusiveMaximum": "below", "maximum": "up to"}


def items_of_the_file():
    """Every item that a vehicle file can have, section by section, from the file's schema."""
    schema = Vehicle.model_json_schema()
    rows, told = [("item", "unit", "accepted")], set()
    for name, section in schema["properties"].items():
        if "patternProperties" in section:
            (section,) = section["patternProperties"].values()
            name = f"{name}.NAME"
        for kind in _kinds(section, schema["$defs"]):
            if "properties" not in kind:
                continue
            words = kind["description"].splitlines()[0]
            if kind["title"] in told:
                rows.append((f"**{name}**", "", f"{words} Items as above."))
                continue
            told.add(kind["title"])
            rows += [(f"**{name}**", "", words), *map(partial(_row, kind), kind["properties"].items())]
    return rows


def vehicles():
    """The vehicles that come with the package."""
    rows = [("vehicle", "is")]
    for name in vehicle_names():
        vehicle, _ = read_vehicle(find_vehicle(name))
        rows.append((f"[{name}](vehicles/{name}.md)", vehicle.description))
    return rows


def figures_of(name):
    """Quantities derived from the parameters of a shipped vehicle."""
    return [Figure._fields, *figures(read_vehicle(find_vehicle(name))[0])]


def parameters_of(name):
    """Every item of a shipped vehicle file."""
    rows = [Parameter._fields]
    for section, items in parameters(find_vehicle(name).read_text(encoding="utf-8")).items():
        rows += [(f"**{section}**",) + ("",) * 4, *items]
    return rows


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
    (section,) = (each for each in section.get("anyOf", [section]) if each.get("type") != "null")
    quantity = section.get("properties", {}).get("value")
    unit = section["properties"]["unit"]["const"] if quantity else ""
    optional = "" if name in kind["required"] else "; may be left out"
    return f"`{name}`", unit, _accepted(quantity or section) + optional


def _accepted(schema):
    """What a value may be, in words."""
    if "anyOf" in schema:
        return ", or ".join(map(_accepted, schema["anyOf"]))
    if "const" in schema or "enum" in schema:
        return ", ".join(f"`{word}`" for word in schema.get("enum", [schema.get("const")]))
    if schema.get("type") == "array":
        low, high = schema.get("minItems", 0), schema.get("maxItems")
        size = f"{low}" if low == high else f"{low} to {high}" if high else f"{low} or more"
        return f"list of {size}, each {_accepted(schema['items'])}"
    if schema.get("type") == "string":
        return "a name of lower-case letters, digits and underscores" if "pattern" in schema else "text"
    bounds = [f"{word} {schema[key]:g}" for key, word in _BOUNDS.items() if key in schema]
    return " ".join(["a whole number" if "multipleOf" in schema else "a number", *bounds])


TABLES = {"items of a vehicle file": items_of_the_file, "vehicles": vehicles}
for _name in vehicle_names():
    TABLES[f"figures of {_name}"] = partial(figures_of, _name)
    TABLES[f"parameters of vehicle {_name}"] = partial(parameters_of, _name)
