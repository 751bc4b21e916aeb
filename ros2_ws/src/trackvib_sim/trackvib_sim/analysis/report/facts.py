"""What was run, by what the nodes' parameters in a bag say."""

from math import isnan
from os.path import abspath, commonpath
from pathlib import PurePath

from ...bags.provenance import parameters_with
from ...road.iso8608 import CLASSES
from ...road_sources.road_file import road_in_words

UNKNOWN = "unknown"


def facts(report_data):
    """Return what was run as pairs of words; without speeds that cannot be had, as the notes say."""
    found = report_data.analysis
    words = {
        "road": _road(report_data) or UNKNOWN,
        "control law": _parameters_with(report_data, "law").get("law", UNKNOWN),
        "speed": _speed(report_data),
        "engine": _engine(found),
        "drive": "" if isnan(found.drive_force) else _drive(found),
        "length": f"{found.duration:.6g} s; {found.measured:.6g} s count, after {found.settle:.3g} s of settling",
        "sensors": f"{_rates(found)}; RMS values from {found.band[0]:g} Hz to half the rate",
        **found.origins,
        "recording": found.bag,
    }
    return [(name, known) for name, known in words.items() if known]


def headline(report_data):
    """Return the run in one line, by the bag's name where it tells nothing."""
    found, road, law = (
        report_data.analysis,
        _road_parameters(report_data),
        _parameters_with(report_data, "law"),
    )
    words = [road["road"]] if "road" in road else []
    words += [] if isnan(found.speed) else [f"{found.speed:.3g} m/s"]
    words += [f"law {law['law']}"] if law else []
    words += [f"seed {road['seed']}"] if "seed" in road else []
    return ", ".join([*(words or names([found.bag])), f"{found.duration:.6g} s"])


def _rates(found):
    if len(set(found.rates.values())) == 1:
        return f"{found.rate:.6g} Hz"
    return ", ".join(f"{sensor} {rate:.6g} Hz" for sensor, rate in found.rates.items())


def _engine(found):
    if isnan(found.engine_speed):
        return ""
    varies = f", standard deviation {found.engine_speed_deviation:.3g} r/min" if found.engine_speed_deviation else ""
    return f"{found.engine_speed:.5g} r/min{varies}"


def _drive(found):
    return f"{found.drive_force / 1e3:.3g} kN, {found.drive_power / 1e3:.3g} kW at the sprockets, mean from the start"


def _parameters_with(report_data, parameter):
    return parameters_with(report_data.provenance, parameter)[1]


def _road(report_data):
    known = _road_parameters(report_data)
    words = [known["road"]] if "road" in known else []
    return ", ".join([*words, f"seed {known['seed']}"] if "seed" in known else words)


def _road_parameters(report_data):
    """What the road node was told, the road in words; a seed only of a class."""
    known = _parameters_with(report_data, "level_until")
    road = known.get("road", known.get("road_class"))  # in bags of before
    if road is None:
        return {}
    return {
        "road": road_in_words(road, known.get("consists_of", "")),
        **({"seed": known["seed"]} if road in CLASSES and "seed" in known else {}),
    }


def _speed(report_data):
    found, simulator = report_data.analysis, _parameters_with(report_data, "engine_speed")
    had = f"{found.speed:.3g} m/s, standard deviation {found.speed_deviation:.2g} m/s"
    words = [] if isnan(found.speed) else [had]
    if drive := simulator.get("drive"):
        words.append(f"drive {PurePath(drive).name}")
    elif "speed" in simulator:
        words.append(f"wanted {simulator['speed']} m/s")
    return "; ".join(words)


def names(paths):
    """Return a short name for each of several bags: what their paths do not share."""
    paths = [PurePath(path) if PurePath(path).name else PurePath(abspath(path)) for path in paths]
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
