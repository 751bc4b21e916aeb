"""The tables of a report as plain text: heads and rows of cells."""

from dataclasses import fields
from math import isfinite
from typing import NamedTuple

from ..numbers import AXES, SENSORS, AxisNumbers

WORDS = {
    "rms": "RMS, band-limited",
    "rms_raw": "RMS, raw, about the mean",
    "peak": "peak, band-limited",
    "rms_weighted": "RMS, weighted",
    "crest_factor": "crest factor (peak / RMS), weighted",
    "mtvv": "greatest RMS over 1 s, weighted (MTVV)",
    "vdv": "vibration dose value, weighted (VDV)",
    "mean": "mean",
}
MOUNT = (  # words, unit, which number of a `MountNumbers`
    ("deflection, mean", "mm", lambda mount: 1e3 * mount.axes["z"].deflection_mean),
    ("travel, RMS", "mm", lambda mount: 1e3 * mount.axes["z"].travel_rms),
    ("travel, peak", "mm", lambda mount: 1e3 * mount.axes["z"].travel_peak),
    ("force, mean", "kN", lambda mount: 1e-3 * mount.axes["z"].force_mean),
    ("force, RMS about the mean", "kN", lambda mount: 1e-3 * mount.axes["z"].force_rms),
    ("force, peak about the mean", "kN", lambda mount: 1e-3 * mount.axes["z"].force_peak),
    ("current, mean", "A", lambda mount: mount.current.mean),
    ("current, least", "A", lambda mount: mount.current.least),
    ("current, greatest", "A", lambda mount: mount.current.greatest),
    ("current, fastest change", "A/s", lambda mount: mount.current.slew),
    ("energy dissipated", "J", lambda mount: mount.energy_dissipated),
    ("power dissipated, mean", "W", lambda mount: mount.power_dissipated),
)
UNITS = {field.name: field.metadata["unit"].replace("^1.75", "¹·⁷⁵") for field in fields(AxisNumbers)}
_COLUMNS = tuple(f"{sensor} {axis}" for axis in AXES for sensor in SENSORS)
_WORRYING = (
    "lost_chassis", "lost_powertrain", "unanswered", "answered_twice", "late", "duplicate", "early", "not_finite",
    "saturated", "silent_periods", "overruns",
)  # fmt: skip


class Table(NamedTuple):
    """A table; the first `words` cells of each row are words, the others numbers."""

    head: tuple
    rows: list
    words: int = 1


def number(value, digits=4):
    """Return a number with so many digits that count; a dash for none."""
    if not isfinite(value):
        return "–"
    words = f"{value:#.{digits}g}" if abs(value) < 10.0**digits else f"{value:.0f}"
    return words.rstrip(".").replace("-", "−")


def change(value, first):
    """Return by how much a number differs from the first one, in words."""
    if not (isfinite(value) and isfinite(first) and first):
        return "–"
    return f"{100.0 * (value / first - 1.0):+.1f} %".replace("-", "−")


def accelerations(analysis):
    """Both sensors by axis, and by how much less the powertrain has."""
    head = ("", "unit", *_COLUMNS, *(f"change {axis}" for axis in AXES))
    rows = []
    for name, words in WORDS.items():
        of = {sensor: [getattr(analysis.sensors[sensor][axis], name) for axis in AXES] for sensor in SENSORS}
        both = list(zip(of["chassis"], of["powertrain"], strict=True))
        changes = [change(p, c) if name != "mean" else "" for c, p in both]
        rows.append((words, UNITS[name], *(number(value) for pair in both for value in pair), *changes))
    power = [analysis.absorbed_power[sensor] for sensor in SENSORS]
    empty = ("",) * (len(SENSORS) * (len(AXES) - 1))
    row = (*empty, *map(number, power), *("",) * (len(AXES) - 1), change(*reversed(power)))
    return Table(head, [*rows, ("absorbed power", "W", *row)], 2)


def further(analysis):
    """Sensors beside the two; without any no rows."""
    head = (
        "further sensors",
        *(f"{kind} {axis}, m/s²" for kind in ("RMS", "weighted") for axis in AXES),
        "absorbed, W",
    )
    rows = [
        (
            name,
            *(number(axes[axis].rms) for axis in AXES),
            *(number(axes[axis].rms_weighted) for axis in AXES),
            number(analysis.absorbed_power[name]),
        )
        for name, axes in analysis.sensors.items()
        if name not in SENSORS
    ]
    return Table(head, rows)


def by_speed(analysis):
    """RMS and absorbed power in bands of speed; of a steady speed no rows."""
    head = ("speed, m/s", "time, s", "engine, r/min", *_COLUMNS, *(f"{sensor}, W" for sensor in SENSORS))
    rows = [
        (
            f"{band.low:g} to {band.high:g}",
            f"{band.measured:.1f}",
            number(band.engine_speed),
            *(number(band.rms[sensor][axis], 3) for axis in AXES for sensor in SENSORS),
            *(number(band.absorbed_power[sensor], 3) for sensor in SENSORS),
        )
        for band in analysis.by_speed
    ]
    return Table(head, rows if len(rows) > 1 else [])


def lines(analysis):
    """What lies in the bands about known lines of the spectrum."""
    head = ("", "Hz", "band, Hz", *_COLUMNS)
    rows = [
        (
            line.name,
            line.hertz if line.sweeps else number(line.frequency),
            f"{line.low:.4g} to {line.high:.4g}",
            *(number(line.rms[sensor][axis], 3) for axis in AXES for sensor in SENSORS),
        )
        for line in analysis.lines
    ]
    return Table(head, rows)


def mounts(analysis):
    """All mounts, along the vertical; without mount states no rows."""
    found = list(analysis.mounts.values())
    rows = [(words, unit, *(number(of(mount)) for mount in found)) for words, unit, of in MOUNT] if found else []
    return Table(("vertical", "unit", *analysis.mounts), rows, 2)


def loop(analysis):
    """What was counted in the loop, and what the simulator told last."""
    return Table(("", ""), [(_spaced(key), str(value)) for key, value in analysis.loop.items() if value is not None])


def worries(analysis):
    """Return in words what was counted in the loop and should not have been, and what is not known of it."""
    counted = {key: _whole(analysis.loop.get(key) or 0) for key in _WORRYING}
    found = [f"{count} {_spaced(key)}" for key, count in counted.items() if count]
    if analysis.loop.get("state") == "failed":
        found.append("the run failed")
    if "late" not in analysis.loop:
        found.append("the recording does not contain the simulator's counters")
    return found


def sound(analysis):
    """Return in words what is known to be right in a loop without `worries`."""
    return "nothing lost, nothing late" + (", every sample answered" if analysis.loop["unanswered"] == 0 else "")


def timing(analysis, title):
    """What the stamps of each topic say, under a title."""
    rows = [
        (
            topic, f"{each.samples}", number(1e3 * each.period), f"{each.first:.6g}", f"{each.last:.6g}",
            f"{each.missing}", f"{each.gap_count}", f"{each.repeated}", f"{each.backward}",
        )
        for topic, each in analysis.timing.items()
    ]  # fmt: skip
    head = (title, "samples", "period, ms", "first, s", "last, s", "missing", "gaps", "repeated", "backward")
    return Table(head, rows)


def gaps(analysis, most=50):
    """The first gaps of each topic."""
    rows = [
        (topic, f"{gap.begin:.7g}", f"{gap.length:.4g}", f"{gap.missing}")
        for topic, each in analysis.timing.items()
        for gap in each.gaps[:most]
    ]
    return Table(("gap in", "after, s", "length, s", "samples missing"), rows)


def _spaced(key):
    return key.replace("_", " ")


def _whole(text):
    try:
        return int(float(text))
    except (ValueError, OverflowError):
        return 0
