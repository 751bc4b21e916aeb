"""The controller study as a picture: constant currents as a curve, every law as a point at its mean current."""

from matplotlib import colormaps
from matplotlib.figure import Figure

from .scenario import QUANTITIES, SCENARIOS

DRAWN = ("powertrain", "powertrain_wk", "force", "travel")


def controllers_picture(rows, file):
    """Draw rows (`controllers_table.Row`) to a PNG file, a column per scenario and a row per quantity."""
    scenarios = list(dict.fromkeys(row.scenario for row in rows))
    laws = sorted({row.law for row in rows if row.current is None})
    colours = dict(zip(laws, colormaps["tab10"].colors * (len(laws) // 10 + 1), strict=False))
    size = (3.4 * len(scenarios) + 0.8, 2.5 * len(DRAWN) + 1.0)
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(DRAWN), len(scenarios), squeeze=False, sharex=True)
    for line, quantity in zip(panels, DRAWN, strict=True):
        for panel, scenario in zip(line, scenarios, strict=True):
            _panel(panel, [row for row in rows if row.scenario == scenario], quantity, colours)
        line[0].set_ylabel(f"{quantity}, {QUANTITIES[quantity][1]}")
    for panel, scenario in zip(panels[0], scenarios, strict=True):
        panel.set_title(SCENARIOS[scenario].title, fontsize=10)
    for panel in panels[-1]:
        panel.set_xlabel("mean current, A")
    figure.suptitle("Control laws beside constant currents:\nbelow the line is better", fontsize=12)
    handles = {label: each for panel in panels.ravel()
               for each, label in zip(*panel.get_legend_handles_labels(), strict=True)}  # fmt: skip
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5, fontsize=9)
    figure.savefig(file, dpi=100, format="png")


def _panel(panel, rows, quantity, colours):
    constants = sorted((row for row in rows if row.current is not None), key=lambda row: row.current)
    places, values = ([row.mean(name) for row in constants] for name in ("current", quantity))
    panel.plot(places, values, ".-", color="0.4", linewidth=1.2, label="constant current")
    for row in rows:
        if row.current is None:
            place = row.mean("current"), row.mean(quantity)
            panel.plot(*place, "o", color=colours[row.law], markersize=6, label=row.law)
    panel.grid(alpha=0.3)
