"""Loops of a mount as pictures: force over displacement and over velocity."""

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

KILO = 1e3


def loops_picture(loops, title, path):
    """Draw `harmonic.Loop`s to a PNG file: a row for each frequency, a colour for each current."""
    frequencies, currents = (sorted({getattr(loop, name) for loop in loops}) for name in ("frequency", "current"))
    figure, plots = _sheet(len(frequencies), title)
    colours = _colours(currents)
    for row, frequency in zip(plots, frequencies, strict=True):
        for loop in loops:
            if loop.frequency == frequency:
                _draw(row, loop, loop.force, color=colours[loop.current], linewidth=1.0)
        row[0].set_ylabel(f"{frequency:g} Hz\nforce, kN")
    _explain(plots, colours)
    figure.savefig(path, dpi=110)


def fit_picture(loops, force, title, path):
    """Draw `measured.MeasuredLoop`s and the fitted force (n,) of each to a PNG file: a row for each current."""
    currents = sorted({loop.current for loop in loops})
    figure, plots = _sheet(len(currents), title)
    for row, current in zip(plots, currents, strict=True):
        for loop, fitted in zip(loops, force, strict=True):
            if loop.current == current:
                _draw(row, loop, loop.force, color="0.6", linewidth=2.0, label="measured")
                _draw(row, loop, fitted, color="#d1662b", linewidth=1.0, label="fitted")
        row[0].set_ylabel(f"{current:g} A\nforce, kN")
    lines, names = plots[0, 0].get_legend_handles_labels()
    plots[0, 0].legend(lines[:2], names[:2], fontsize=8)
    _explain(plots, {})
    figure.savefig(path, dpi=110)


def _sheet(rows, title):
    size = 12.0, 1.0 + 2.6 * rows
    figure = Figure(figsize=size, layout="constrained")
    plots = figure.subplots(rows, 2, sharex="col", squeeze=False)
    figure.suptitle(title)
    return figure, plots


def _draw(row, loop, force, **style):
    row[0].plot(KILO * loop.displacement, force / KILO, **style)
    row[1].plot(loop.velocity, force / KILO, **style)


def _colours(currents):
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(currents)))
    return dict(zip(currents, shades, strict=True))


def _explain(plots, colours):
    for plot in plots.flat:
        plot.grid(alpha=0.3)
    for plot, name in zip(plots[-1], ("displacement, mm", "velocity, m/s"), strict=True):
        plot.set_xlabel(name)
    if colours:
        lines = [Line2D([], [], color=colour) for colour in colours.values()]
        plots[0, 0].legend(lines, [f"{current:g} A" for current in colours], fontsize=8, ncols=2)
