"""The table study as a picture: levels over road classes, ours with scatter and the paper's."""

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from ..case import BAND
from .paper_table import SENSORS

AXES = ("longitudinal X", "vertical Y", "lateral Z")
SPREAD = 0.24  # of the distance between two classes, over which the speeds of one are spread


def table_picture(rows, paper, seeds, file):
    """Draw rows (`paper_table.Row`) and the paper's values ((class, speed) -> (6,)) beside them to a PNG file."""
    classes = sorted({row.road_class for row in rows})
    speeds = sorted({row.speed for row in rows})
    colours = colormaps["viridis"](np.linspace(0.08, 0.82, len(speeds)))
    shifts = np.linspace(-SPREAD, SPREAD, len(speeds)) if len(speeds) > 1 else np.zeros(1)
    figure = Figure(figsize=(13, 7.5), layout="constrained")
    panels = figure.subplots(2, 3, sharex=True, sharey=True)
    for column, panel in enumerate(panels.ravel()):
        for speed, colour, shift in zip(speeds, colours, shifts, strict=True):
            mine = [row for row in rows if row.speed == speed]
            place = np.array([classes.index(row.road_class) for row in mine]) + shift
            _ours(panel, place, mine, column, colour)
            theirs = [paper.get((row.road_class, speed), np.full(6, np.nan))[column] for row in mine]
            panel.plot(place, theirs, "D", color="none", markeredgecolor=colour, markersize=9, markeredgewidth=1.4)
        panel.set_title(f"{SENSORS[column // 3]}, {AXES[column % 3]}", fontsize=10)
        _axes(panel, classes)
    for panel in panels[:, 0]:
        panel.set_ylabel("RMS acceleration, m/s²")
    for panel in panels[-1]:
        panel.set_xlabel("road class (ISO 8608)")
    runs = "1 seed" if seeds == 1 else f"{seeds} seeds, bars: standard deviation"
    band = f"{BAND[0]:g}-{BAND[1]:g} Hz"
    figure.suptitle(f"RMS accelerations beside Table 1 of [Tao2025]: {band}, paper axes, {runs}", fontsize=12)
    figure.legend(handles=_legend(speeds, colours), loc="outside lower center", ncols=len(speeds) + 3, fontsize=9)
    figure.savefig(file, dpi=110, format="png")


def _ours(panel, place, rows, column, colour):
    values = np.array([row.rms[column] for row in rows])
    scatter = [row.scatter[column] for row in rows]
    panel.errorbar(place, values, scatter, fmt="o-", color=colour, markersize=5, linewidth=1.0, capsize=3)
    missing = place[np.isnan(values)]
    panel.plot(missing, np.full(len(missing), 0.03), "x", color=colour, transform=panel.get_xaxis_transform())


def _axes(panel, classes):
    panel.set_yscale("log")
    panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.yaxis.set_major_formatter(ScalarFormatter())
    panel.yaxis.set_minor_formatter(NullFormatter())
    panel.set_xticks(range(len(classes)), classes)
    panel.grid(alpha=0.3, which="both", axis="y")


def _legend(speeds, colours):
    handles = [Line2D([], [], color=colour, linewidth=2.5, label=f"{speed:g} m/s")
               for speed, colour in zip(speeds, colours, strict=True)]  # fmt: skip
    return handles + [
        Line2D([], [], marker="o", color="0.3", markersize=5, label="trackvib"),
        Line2D([], [], marker="D", color="0.3", markerfacecolor="none", markersize=9, linestyle="", label="[Tao2025]"),
        Line2D([], [], marker="x", color="0.3", linestyle="", label="outside the valid range"),
    ]
