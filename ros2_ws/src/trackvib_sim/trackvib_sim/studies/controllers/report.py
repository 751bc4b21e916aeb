"""The Markdown report of the controller study: levels of every law, and what it gains over constant currents."""

import numpy as np

from ...bags.versions import versions
from ..case_store import program, text_hash
from .scenario import ABOVE_BAND, DRIVING, PASSIVE_CURRENT, QUANTITIES, SCENARIOS
from .table import ALIKE, JUDGED, SURE, verdict

_HASH = 12  # digits


def report(rows, seeds, vehicle_name, vehicle_text):
    """Return the report as Markdown text; rows are `controllers_table.Row`, `seeds` the runs a scenario that varies."""
    parts = [_head(seeds, vehicle_name, vehicle_text), _verdict(rows), _share(rows)]
    return "\n".join(parts + [_levels(rows, name) for name in dict.fromkeys(row.scenario for row in rows)])


def _head(seeds, vehicle_name, vehicle_text):
    lines = "\n".join(f"* `{name}`: {what}, {unit}" for name, (what, unit) in QUANTITIES.items())
    return f"""# Control laws and constant currents compared

The engine excites the powertrain by forces and moments of its orders, at {DRIVING:g} r/min where the vehicle moves.
Means over {seeds} seeds, each with its own road and phase between the two tracks (one run where nothing is random).
Quantities:

{lines}

* vehicle file: `{vehicle_name}`, SHA-256 `{text_hash(vehicle_text)[:_HASH]}`
* program: trackvib_sim {versions()["trackvib_sim"]}, SHA-256 of the simulation's modules `{program()[:_HASH]}`
"""


def _verdict(rows):
    lines = [
        "## Gains",
        "",
        "Reduction of each quantity in percent (negative: increase), mean ± half of the 95 % interval by Student's t",
        f"over the seeds, every seed compared with itself; a star where {SURE}.",
        "Constant current and law are those with the least of that quantity over all seeds; the gain of each seed is",
        "that of the choice by all other seeds. Chance is the scatter of the means among constant currents",
        f"from {ALIKE:g} A, whose mounts are nearly alike: tracks amplify the smallest difference, and a gain of",
        "that size has no significance.",
        "",
        *_header("scenario", "quantity", "best constant, A", "over 1 A", "best law", "over 1 A", "over best", "chance"),
    ]
    for each in verdict(rows):
        constant = f"{each.current:g}", each.constant_gain.text()
        law = f"`{each.law}`", each.law_gain.text(), each.over_best.text()
        scenario, quantity = SCENARIOS[each.scenario].title, f"`{each.quantity}`"
        lines.append(_line(scenario, quantity, *constant, *law, f"{each.chance:.1f}"))
    return "\n".join(lines) + "\n"


def _share(rows):
    lines = [
        "## What no current reaches",
        "",
        f"Vertical acceleration of the powertrain above {ABOVE_BAND:g} Hz and of the hull, RMS in m/s²: with passive",
        f"mounts at {PASSIVE_CURRENT:g} A, as a fraction of the powertrain's mean square, and the range of all runs.",
        "",
        *_header("scenario", f"above {ABOVE_BAND:g} Hz", "of the mean square", "least to most", "hull, least to most"),
    ]
    for scenario in dict.fromkeys(row.scenario for row in rows):
        mine = [row for row in rows if row.scenario == scenario and not row.failures]
        passive = next((row for row in mine if row.current == PASSIVE_CURRENT), None)
        if passive is None:
            continue
        high = passive.mean("powertrain_high")
        share = (passive.levels["powertrain_high"] / passive.levels["powertrain"]) ** 2
        ranges = (_range(mine, quantity) for quantity in ("powertrain_high", "hull"))
        lines.append(_line(SCENARIOS[scenario].title, f"{high:#.3g}", f"{100.0 * share.mean():.0f} %", *ranges))
    return "\n".join(lines) + "\n"


def _range(rows, quantity):
    values = [row.mean(quantity) for row in rows]
    return f"{min(values):#.3g} to {max(values):#.3g}"


def _levels(rows, scenario):
    lines = [f"## Levels: {SCENARIOS[scenario].title}", "", *_header("law or constant current", *QUANTITIES)]
    mine = [row for row in rows if row.scenario == scenario]
    good = [row for row in mine if not row.failures]
    least = {name: min((row.mean(name) for row in good), default=np.nan) for name in JUDGED}
    for row in sorted(mine, key=lambda row: (row.current is None, row.current or 0.0, row.law)):
        name = f"`{row.law}`" if row.current is None else row.name
        lines.append(_line(name, *(_cell(row, quantity, least) for quantity in QUANTITIES)))
    failed = [f"* {row.name}: {each}" for row in mine for each in row.failures]
    return "\n".join(lines + ([""] + failed if failed else [])) + "\n"


def _cell(row, quantity, least):
    """Bold where it is the least of all to the digits shown."""
    value = row.mean(quantity)
    text = f"{value:#.3g}" if np.isfinite(value) else "-"
    return f"**{text}**" if quantity in JUDGED and text == f"{least[quantity]:#.3g}" else text


def _header(*names):
    return [_line(*names), "|" + "---|" * len(names)]


def _line(*cells):
    return f"| {' | '.join(cells)} |"
