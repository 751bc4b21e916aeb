"""What was run, by what the nodes' parameters in a bag say."""

from os.path import commonpath
from pathlib import PurePath

from ...bags.provenance import parameters, parameters_with

NOT_TOLD = "not told"


def facts(excerpt):
    """Return what was run as pairs of words."""
    found, road = excerpt.analysis, parameters_with(excerpt.provenance, "road_class")[1]
    law, simulator = (parameters_with(excerpt.provenance, name)[1] for name in ("law", "engine_speed"))
    return [
        ("road", f"class {road.get('road_class', NOT_TOLD)}, seed {road.get('seed', NOT_TOLD)}"),
        ("control law", law.get("law", NOT_TOLD)),
        ("speed", f"{found.speed:.3g} m/s, standard deviation {found.speed_deviation:.2g} m/s; "
                  f"wanted {simulator.get('speed', NOT_TOLD)} m/s"),
        ("engine", f"{found.engine_speed:.5g} r/min"),
        ("length", f"{found.duration:.6g} s; {found.measured:.6g} s count, after {found.settle:.3g} s of settling"),
        ("sensors", f"{found.rate:.6g} Hz; RMS values from {found.band[0]:g} to {found.band[1]:g} Hz"),
        ("bag", found.bag),
    ]  # fmt: skip


def headline(excerpt):
    """Return the run in one line."""
    road, law = (parameters_with(excerpt.provenance, name)[1] for name in ("road_class", "law"))
    words = [f"class {road['road_class']}"] if "road_class" in road else []
    words += [f"{excerpt.analysis.speed:.3g} m/s"]
    words += [f"law {law['law']}"] if "law" in law else []
    words += [f"seed {road['seed']}"] if "seed" in road else []
    return ", ".join([*words, f"{excerpt.analysis.duration:.6g} s"])


def names(paths):
    """Return a short name for each of several bags: what their paths do not share."""
    paths = [PurePath(path) for path in paths]
    if len(paths) == 1:
        return [str(PurePath(*paths[0].parts[-2:]))]
    try:
        shared = len(PurePath(commonpath(paths)).parts)
    except ValueError:  # absolute and relative ones
        shared = 0
    parts = [path.parts[shared:] for path in paths]
    while all(len(each) > 1 for each in parts) and len({each[-1] for each in parts}) == 1:
        parts = [each[:-1] for each in parts]  # "bag", as every run calls its own
    found = [str(PurePath(*each)) if each else path.name for each, path in zip(parts, paths, strict=True)]
    return [name if found.count(name) == 1 else f"{name} ({1 + index})" for index, name in enumerate(found)]


def differing(excerpts):
    """Return rows (node, parameter, value in each bag) of the parameters that are not the same everywhere."""
    told = [
        {node.rpartition("/")[2]: values for node, values in parameters(excerpt.provenance).items()}
        for excerpt in excerpts
    ]
    keys = sorted({(node, name) for each in told for node, values in each.items() for name in values})
    rows = [(node, name, *(each.get(node, {}).get(name, NOT_TOLD) for each in told)) for node, name in keys]
    return [row for row in rows if len(set(row[2:])) > 1]
