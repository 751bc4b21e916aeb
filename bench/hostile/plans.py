"""Calibration plans: the shipped one with wrong structure, types, numbers and names, tricks of YAML, harmed bytes."""

import copy
import datetime
import math
import tempfile
from pathlib import Path

import yaml
from trackvib_sim.data import calibration_plan_file, find_vehicle, paper_table_file
from trackvib_sim.studies.calibration.plan import PlanError, read_plan
from trackvib_sim.studies.calibration.vehicle_text import calibrated_vehicle_text
from trackvib_sim.studies.paper.paper_table import read_table
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle

from .odd_values import CONTROL
from .trial import Wrong

REFUSALS = (PlanError,)
SHARES = (0.0, 1e-9, 0.3, 0.5, 1.0)
FACTORS = (0.0, 1e-300, 1e-12, 0.5, 0.99, 1.01, 2.0, 10.0, 1e12, 1e300, -1.0)
ODD = (
    None, True, 0, -1, 3, 1.5, 1e308, -1e308, 5e-324, math.inf, -math.inf, math.nan, 2**63, 10**99, 10**200, "", "x",
    "x" * 5000, CONTROL, "hull.mass", "hull.mass[0]", "sprockets.z[0]", "hull.mass\n", "hull", "a.b[9]", "__class__.x",
    "hull.__dict__", "log", [], {}, [[]], {"a": 1}, {1: 2}, ["A", 5], ["A", 5, 5], [["A", 5.0]] * 5000,
    datetime.date(2001, 1, 1), b"bytes", {"x"},
)  # fmt: skip
TRICKS = (
    "*a", "&a x", "&a [*a]", "!!python/object/apply:os.system [ls]", "!!binary x", "!!timestamp 2001-99-99", "!!int ''",
    "!!float x", "!!bool q", "!!set {a, b}", "!!omap [a: 1]", "!!pairs [a: 1]", "1:2:3", "1:" * 200 + "1", "0x_", "0b_",
    "._", "+.inf", ".nan", "~", "<<: {a: 1}", "<<: [1]", "? [1]", "? {a: 1}\n: 2", "---", "...", "%YAML 9.9", "{", "}",
    "[" * 60, "[" * 3000, "\0", "\ufeff", "\t", "\x1b", "=", "|+9", ">-", "'", '"', "\\", ": ", "- ", "#", "9" * 5000,
    "1e400", "2001-01-01 25:00:00", "\u2028", "\x85", "@", "`", "!", "!!", "!<x>", "&", "*",
)  # fmt: skip


def trials(chance, count):
    """Yield so many plans, read for the shipped vehicle."""
    shipped = calibration_plan_file().read_text(encoding="utf-8")
    content = yaml.safe_load(shipped)
    vehicle_text, paper = read_vehicle(find_vehicle())[1], read_table(paper_table_file())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plan.yaml"
        for _ in range(count):
            done, text = [], shipped
            how = chance.choice(("structure", "structure", "text", "both"))
            if how != "text":
                text = yaml.safe_dump(_restructured(content, chance, done), sort_keys=False)
            data = (_tricky(text, chance, done) if how != "structure" else text).encode()
            path.write_bytes(_harmed(data, chance, done) if chance.random() < 0.05 else data)
            yield "; ".join(done), lambda: _attempt(path, vehicle_text, paper)


def _places(node, path=()):
    """Return the places of everything in a plan."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    return [path, *(place for key, each in items for place in _places(each, (*path, key)))]


def _restructured(content, chance, done):
    """Return a copy with one to three things in it replaced, scaled, removed, renamed, added or repeated."""
    new = copy.deepcopy(content)
    for _ in range(chance.randint(1, 3)):
        places = _places(new)[1:]
        if not places:
            break
        *path, last = chance.choice(places)
        holder = new
        for step in path:
            holder = holder[step]
        how, old = chance.choice(("replace", "scale", "scale", "remove", "rename", "add", "repeat")), holder[last]
        if how == "scale" and type(old) in (int, float):
            holder[last] = old * chance.choice(FACTORS)
        elif how == "remove":
            del holder[last]
        elif how == "rename" and isinstance(holder, dict):
            holder[chance.choice(("x", "", 1, None, CONTROL, "items", f"{last} "))] = holder.pop(last)
        elif how == "add" and isinstance(old, dict):
            old[chance.choice(("colour", 7, "x" * 5000, CONTROL))] = chance.choice(ODD)
        elif how == "repeat" and isinstance(holder, list):
            holder += [copy.deepcopy(old)] * chance.choice((1, 50))
        else:
            holder[last] = copy.deepcopy(chance.choice(ODD))
            how = f"replace by {holder[last]!r:.40}"
        done.append(f"{'.'.join(map(str, (*path, last)))[:80]!r} {how}")
    return new


def _tricky(text, chance, done):
    """Return the text with one or two values replaced by tricks, or tricks put between its lines."""
    lines = text.split("\n")
    for _ in range(chance.randint(1, 2)):
        number, trick = chance.randrange(len(lines)), chance.choice(TRICKS)
        key, colon, _ = lines[number].partition(": ")
        lines[number] = f"{key}{colon}{trick}" if colon and chance.random() < 0.7 else f"{trick}\n{lines[number]}"
        done.append(f"line {number}: {trick!r:.40}")
    return "\n".join(lines)


def _harmed(data, chance, done):
    """Return bytes with some of them wrong, or cut."""
    new = bytearray(data)
    for _ in range(chance.randint(1, 3)):
        new[chance.randrange(len(new))] = chance.randrange(256)
    size = chance.choice((len(new), chance.randrange(len(new))))
    done.append(f"bytes harmed, {size} left")
    return bytes(new[:size])


def _attempt(path, vehicle_text, paper):
    plan = read_plan(path, vehicle_text, paper)
    for share in SHARES:
        values = plan.values([share] * len(plan.parameters))
        for parameter, value in zip(plan.parameters, values, strict=True):
            if not (parameter.low <= value <= parameter.high and 0.0 <= parameter.share(value) <= 1.0):
                raise Wrong(f"{parameter.item} is {value} at a share of {share}, back {parameter.share(value)}")
    vehicle = parse_vehicle(calibrated_vehicle_text(vehicle_text, plan.parameters, values), "at the upper bounds")
    if [parameter.of(vehicle) for parameter in plan.parameters] != values:
        raise Wrong("a vehicle file says something else")
    return "a plan"
