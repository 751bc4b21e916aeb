"""The M113 study as a picture: third octaves, lines and the road-borne part, ours and the reference's."""

import numpy as np
from matplotlib.figure import Figure

from .case import places, road_borne
from .measures import LINES, THIRD_OCTAVES, line_name, octave_name
from .reference import ROUGH, references
from .variants import BASE

OURS, THEIRS = "C0", "0.35"
SHOWN = 25.0  # m of the road-borne part


def m113_picture(rows, found, file):
    """Draw rows (`table.Row`) and the road-borne parts of results (dict of cases) to a PNG file."""
    cases = list(dict.fromkeys((row.road, row.speed) for row in rows))
    figure = Figure(figsize=(3.6 * len(cases), 8.0), layout="constrained")
    panels = figure.subplots(3, len(cases))
    by_name = {(row.quantity, row.road, row.speed): row for row in rows if row.variant == BASE}
    for column, case in zip(panels.T, cases, strict=True):
        _levels(column[0], THIRD_OCTAVES, [by_name[(octave_name(c), *case)] for c in THIRD_OCTAVES])
        column[0].set_xscale("log")
        column[0].set_xticks(THIRD_OCTAVES, [f"{c:.0f}" for c in THIRD_OCTAVES], fontsize=7)
        column[0].minorticks_off()
        column[0].set_xlabel("third octave, Hz")
        column[0].set_title(f"{references()[case].name}", fontsize=10)
        _levels(column[1], LINES, [by_name[(line_name(k), *case)] for k in LINES])
        column[1].set_xticks(LINES)
        column[1].set_xlabel("line k v/p")
        _history(column[2], case, found)
    for row in panels:
        row[0].set_ylabel("RMS, m/s²")
    panels[2, 0].set_ylabel("0.5-5 Hz, m/s²")
    figure.suptitle("M113, vertical acceleration of the hull at its centre of mass: trackvib and Project Chrono")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=9)
    figure.savefig(file, dpi=100, format="png")


def _levels(panel, places_, rows):
    panel.plot(places_, [row.ours for row in rows], "o-", color=OURS, label="trackvib")
    panel.plot(places_, [row.theirs for row in rows], "D--", color=THEIRS, label="Project Chrono")
    panel.set_ylim(bottom=0.0)
    panel.grid(alpha=0.3)


def _history(panel, case, found):
    reference = references()[case]
    place = places(reference)
    shown = place < place[0] + SHOWN
    if case[0] == ROUGH:
        ours = [
            r.road_borne for c, r in found.items() if (c.variant, c.road, c.speed) == (BASE, *case) and r.road_borne
        ]
        panel.plot(place[shown], np.array(ours).T[shown], color=OURS, linewidth=0.7, alpha=0.6)
    panel.plot(place[shown], road_borne(reference)[shown], color=THEIRS, linewidth=1.4)
    panel.set_xlabel("place, m")
    panel.grid(alpha=0.3)
