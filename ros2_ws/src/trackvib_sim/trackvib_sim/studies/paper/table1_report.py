"""The Markdown report of the table study: ours beside the paper's, row by row, column by column, and the reductions."""

import numpy as np

from ...bags.versions import versions
from ..case import BAND, ENGINE_SPEED, GOOD, MEASURING
from ..case_store import program, text_hash
from .paper_table import SENSORS, column_bias, error_factor, given, reduction

_NAMES = tuple(f"{sensor} {axis}" for sensor in SENSORS for axis in "XYZ")
_HASH = 12  # digits


def report(rows, paper, seeds, predictions, vehicle_name, vehicle_text):
    """Return the report as Markdown text.

    Parameters
    ----------
    rows : sequence of paper_table.Row
    paper : dict
        (class, speed) -> values (6,), as `paper_table.read_table` gives it.
    seeds : int
        Number of runs a row.
    predictions : sequence of predictions.Prediction
    vehicle_name, vehicle_text : str
        Of the vehicle file.
    """
    parts = [_head(seeds, vehicle_name, vehicle_text), _levels(rows, paper)]
    if given(rows, paper).size:
        parts.append(_comparison(*given(rows, paper), predictions))
    return "\n".join([*parts, _reductions(rows, paper)])


def _head(seeds, vehicle_name, vehicle_text):
    return f"""# Table 1 of [Tao2025] and ours

RMS accelerations in m/s² over {BAND[0]:g}-{BAND[1]:g} Hz (the paper's band is unknown) during {MEASURING:g} s after
settling, in the paper's axes: X longitudinal, Y vertical, Z lateral (ROS x, z, y). Chassis is the hull at the
powertrain's rear connection, powertrain its input end, midway between the MR mounts. Engine at
{ENGINE_SPEED:g} r/min, its second order imposed across the mounts; 1 A in both coils. Ours are means ± standard
deviations over {seeds} seeds, each with its own road and its own phase between the two tracks.

* vehicle file: `{vehicle_name}`, SHA-256 `{text_hash(vehicle_text)[:_HASH]}`
* program: trackvib_sim {versions()["trackvib_sim"]}, SHA-256 of the simulation's modules `{program()[:_HASH]}`
"""


def _levels(rows, paper):
    lines = ["## Levels", "", "Ours ± scatter, and in brackets the values of the paper where available.", ""]
    lines += _header("class", "m/s", *_NAMES, "error factor", "status")
    for row in rows:
        theirs = paper.get((row.road_class, row.speed), [None] * 6)
        cells = [_level(*each) for each in zip(row.rms, row.scatter, theirs, strict=True)]
        pair = given([row], paper)
        factor = f"{error_factor(*pair):.3f}" if pair.size else ""
        lines.append(_line(row.road_class, f"{row.speed:g}", *cells, factor, row.status))
    outside = [f"{row.road_class} at {row.speed:g} m/s" for row in rows if row.status != GOOD]
    if outside:
        lines += ["", f"Partly or wholly outside the valid range: class {', '.join(outside)}."]
    return "\n".join(lines) + "\n"


def _level(ours, scatter, theirs):
    cell = f"{ours:.2f}" if np.isfinite(ours) else "-"
    if np.isfinite(scatter):
        cell += f" ± {scatter:.2f}"
    return cell if theirs is None else f"{cell} ({theirs:.2f})"


def _comparison(ours, paper, predictions):
    lines = [
        "## Comparison",
        "",
        f"Error factor exp(rms(log(ours / paper))) over the {len(ours)} common rows: "
        f"**{error_factor(ours, paper):.3f}**. By column:",
        "",
        *_header("", *_NAMES),
        _line("error factor", *(f"{error_factor(*each):.3f}" for each in zip(ours.T, paper.T, strict=True))),
        _line("bias, geometric mean of ours / paper", *(f"{bias:.3f}" for bias in column_bias(ours, paper))),
        "",
        "For comparison: models that know only the speed, fitted to the rows of the paper. In the second column",
        "each road class is predicted by models fitted, or calibrated, without it.",
        "",
        *_header("", "fitted to them", "classes left out"),
        *(_line(each.name, *(f"{value:.3f}" if np.isfinite(value) else "-" for value in each[1:]))
          for each in predictions),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _reductions(rows, paper):
    lines = [
        "## Powertrain against chassis",
        "",
        "Powertrain level below the chassis level in percent (negative: above): with our mounts, with rigid mounts",
        "(the hull's own point at the powertrain's sensor, the effect of position alone), and in the paper.",
        "",
    ]
    kinds = ("ours", "rigid", "paper")
    lines += _header("class", "m/s", *(f"{axis} {kind}" for axis in "XYZ" for kind in kinds))
    for row in rows:
        if not np.isfinite(row.rms).all():
            continue
        theirs = paper.get((row.road_class, row.speed), np.full(6, np.nan))
        values = np.stack((reduction(row.rms), reduction(row.rms, row.rigid), reduction(theirs)), axis=1)
        cells = [f"{value:.1f}" if np.isfinite(value) else "" for value in values.ravel()]
        lines.append(_line(row.road_class, f"{row.speed:g}", *cells))
    return "\n".join(lines) + "\n"


def _header(*names):
    return [_line(*names), "|" + "---|" * len(names)]


def _line(*cells):
    return f"| {' | '.join(cells)} |"
