"""The Markdown report of a calibration."""

import numpy as np

from ..case import BAND
from ..paper.paper_table import COLUMNS, column_bias, error_factor
from .history import ALIKE
from .objective import level_speeds
from .sensitivity import PER, REACH

NEAR = 0.05  # share of the range that counts as near a bound


def report(plan, start, history, rows, sensitive):
    """Return the report as Markdown text.

    Parameters
    ----------
    plan : calibration_plan.Plan
    start : sequence of float
        Values of the parameters before.
    history : calibration_history.History
    rows : sequence of (str, float)
        Class and speed of each row.
    sensitive : sensitivity.Sensitivity
        At the best candidate.
    """
    best, first, neighbours = history.chosen, history.candidates[0], history.alike
    return "\n".join(
        [
            _head(plan, history, rows, best, first),
            _columns(best, first),
            _rows(rows, best),
            _resistance(rows, history, best, first),
            _parameters(plan, start, best, neighbours, sensitive),
            _sources(plan),
        ]
    )


def _head(plan, history, rows, best, first):
    generations = max(candidate.generation for candidate in history.candidates)
    named = ", ".join(f"{road_class} at {speed:g}" for road_class, speed in rows)
    return f"""# Calibration

{len(plan.parameters)} parameters of the vehicle, fitted to {len(rows)} rows of Table 1 of [Tao2025]
(class {named} m/s).
RMS over {BAND[0]:g}-{BAND[1]:g} Hz during {plan.measuring:g} s, {plan.seeds} runs per row.
Objective: rms(log(ours / paper)) over all numbers of the table, plus the rms over the speeds of the deviation of the
running resistance from the range of the published formulas, as a logarithm.
Search: CMA-ES, {generations} generations of {plan.population}, seed {plan.seed}.

| | start | calibrated |
|---|---|---|
| objective | {first.objective:.4f} | {best.objective:.4f} |
| error factor | {_plain(error_factor(first.ratios, 1.0))} | {_plain(error_factor(best.ratios, 1.0))} |

The calibrated set is candidate {best.index} of generation {best.generation}: of all candidates whose objective
is at most {100.0 * (ALIKE - 1.0):.0f} % above the smallest, {history.best.objective:.4f}, it has the lowest running
resistance. The order of the best candidates is partly chance: the standard error of one number, from the scatter among
the runs of a row, is {_percent(best.scatter)}.
For a fair comparison use `trackvib study table1` with `vehicle.yaml`, which drives over other roads.
"""


def _columns(best, first):
    lines = ["## Mean bias of the columns", "", "Geometric mean of ours / paper, in the paper's axes.", ""]
    lines += ["| | " + " | ".join(COLUMNS) + " |", "|" + "---|" * (len(COLUMNS) + 1)]
    for name, candidate in (("start", first), ("calibrated", best)):
        lines.append(_line(name, *map(_plain, column_bias(candidate.ratios, 1.0))))
    return "\n".join(lines) + "\n"


def _rows(rows, best):
    lines = ["## Rows", "", "Ours / paper of the calibrated set.", ""]
    lines += ["| class | m/s | " + " | ".join(COLUMNS) + " | factor |", "|" + "---|" * (len(COLUMNS) + 3)]
    for (road_class, speed), ratios in zip(rows, best.ratios, strict=True):
        lines.append(_line(road_class, f"{speed:g}", *map(_plain, (*ratios, error_factor(ratios, 1.0)))))
    return "\n".join(lines) + "\n"


def _resistance(rows, history, best, first):
    good = [each for each in history.candidates if np.isfinite(each.ratios).all()]
    table = min(good, key=lambda each: error_factor(each.ratios, 1.0), default=best)
    lines = ["## Running resistance", "", "On level ground, relative to the lowest and the highest formula.", ""]
    speeds = level_speeds(rows)
    lines += [_line("", *(f"{speed:g} m/s" for speed in speeds), "error factor"), "|" + "---|" * (len(speeds) + 2)]
    named = ("start", first), ("calibrated", best), ("least objective", history.best), ("best for the table", table)
    for name, each in named:
        cells = (f"{_plain(low)}, {_plain(high)}" for low, high in each.resistance)
        lines.append(_line(name, *cells, _plain(error_factor(each.ratios, 1.0))))
    return "\n".join([*lines, "", "![frontier](frontier.png)"]) + "\n"


def _parameters(plan, start, best, neighbours, sensitive):
    lines = [
        "## Parameters",
        "",
        f"The set is not unique: *neighbours* is the range of all {len(neighbours)} candidates whose objective is at "
        f"most {100.0 * (ALIKE - 1.0):.0f} % above the smallest.",
        "*Strength* is the change of the RMS when the parameter changes by "
        f"{100.0 * PER:.0f} % of its range, as root mean square over all numbers of the table, from runs "
        f"{100.0 * REACH:.0f} % below and above; noise alone gives {_percent(sensitive.noise)}. Strongest first.",
        "",
        "| parameter | low | high | scale | start | calibrated | near a bound | neighbours | strength |",
        "|" + "---|" * 9,
    ]
    for k in sensitive.order:
        parameter, value = plan.parameters[k], best.values[k]
        share = parameter.share(value)
        near = "low" if share < NEAR else "high" if share > 1.0 - NEAR else ""
        others = [neighbour.values[k] for neighbour in neighbours]
        lines.append(
            _line(
                f"`{parameter.item}`",
                *(f"{each:g}" for each in (parameter.low, parameter.high)),
                parameter.scale,
                *(f"{each:g}" for each in (start[k], value)),
                near,
                f"{min(others):g} to {max(others):g}",
                _percent(sensitive.strength[k]),
            )
        )
    return "\n".join([*lines, "", "![search](convergence.png)", "", "![sensitivity](sensitivity.png)"]) + "\n"


def _sources(plan):
    lines = ["## Sources of the bounds", ""]
    return "\n".join([*lines, *(f"* `{each.item}`: {each.source}" for each in plan.parameters)]) + "\n"


def _line(*cells):
    return f"| {' | '.join(cells)} |"


def _plain(value):
    return f"{value:.3f}" if np.isfinite(value) else "-"


def _percent(value):
    return f"{100.0 * value:.1f} %" if np.isfinite(value) else "not known"
