"""Calibrated values in the text of a vehicle file; comments, layout and all other items stay as they are."""

import json
import re

import numpy as np
import yaml

from ...yaml_text import compose

_WITHIN = re.compile(r"(^|; )(\[\d+\] )?within \S+ to [^\s;]+")


def calibrated_vehicle_text(text, parameters, values):
    """Return the text of a vehicle file with calibrated values, marked so and with their bounds in the note.

    Parameters
    ----------
    text : str
        A valid vehicle file.
    parameters : sequence of calibration_plan.Parameter
    values : sequence of float

    Raises
    ------
    ValueError
        The file has no such item.
    """
    edits, by_quantity = [], {}
    root = compose(text, "vehicle file")
    for parameter, value in zip(parameters, values, strict=True):
        quantity = _quantity(root, parameter)
        by_quantity.setdefault(parameter.quantity, (quantity, []))[1].append(parameter)
        edits.append((*_span(_number(quantity, parameter)), number(value)))
    for quantity, among in by_quantity.values():
        edits += _marks(quantity, among)
    for start, end, new in sorted(edits, reverse=True):
        text = text[:start] + new + text[end:]
    return text


def number(value):
    """Return a number as YAML 1.1 and 1.2 read it, large and small ones with an exponent."""
    if value == 0.0 or 1e-4 <= abs(value) < 1e5:
        return repr(float(value))
    return np.format_float_scientific(value, trim="0", exp_digits=1)


def _quantity(root, parameter):
    """Return a quantity's items: key -> node of its value."""
    node = root
    for name in parameter.quantity.split("."):
        node = _items(node).get(name)
        if node is None:
            raise ValueError(f"{parameter.item}: the vehicle file has no {name!r}")
    return _items(node)


def _items(node):
    if not isinstance(node, yaml.MappingNode):
        return {}
    return {key.value: value for key, value in node.value}


def _number(quantity, parameter):
    """Return the node of the one number that a parameter stands for."""
    node, k = quantity.get("value"), parameter.component
    if isinstance(node, yaml.SequenceNode) and k is not None and k < len(node.value):
        return node.value[k]
    if isinstance(node, yaml.ScalarNode) and k is None:
        return node
    has = f"is a list of {len(node.value)}: name one as {parameter.quantity}[0]" if k is None else "has no such element"
    raise ValueError(f"{parameter.item}: the vehicle file's {parameter.quantity} {has}")


def _marks(quantity, parameters):
    """Return the edits of a quantity's source and note; what the note said before is kept."""
    old = quantity["note"].value if "note" in quantity else ""
    said = [part for part in [_WITHIN.sub("", old)] if part]
    bounds = [f"{_element(each)}within {number(each.low)} to {number(each.high)}" for each in parameters]
    note = json.dumps("; ".join(said + bounds), ensure_ascii=False)
    if "note" in quantity:
        return [(*_span(quantity["source"]), "calibrated"), (*_span(quantity["note"]), note)]
    start, end = _span(quantity["source"])
    return [(start, end, f"calibrated, note: {note}")]


def _element(parameter):
    return "" if parameter.component is None else f"[{parameter.component}] "


def _span(node):
    return node.start_mark.index, node.end_mark.index
