"""How every figure of a report looks. Text and grid get their colours from the page, which follows light and dark."""

from html import escape
from math import log10

import numpy as np
import plotly.graph_objects as go

from ..labels import joined
from ..sensor_style import COLOURS, LOWEST_FREQUENCY, NAMES

SENSOR_COLOURS = COLOURS
AXIS_COLOURS = {"x": "#2a9d8f", "y": "#9467bd", "z": "#c8453c"}
_MOUNT_COLOURS = ("#2a9d8f", "#b0508f", "#d99a1c", "#4aa3df")
BAG_COLOURS = ("#1b9e77", "#cc5a9b", "#d99a1c", "#4aa3df", "#8c6bb1", "#808080")
BAG_DASHES = ("solid", "dash", "dot")  # for more bags than colours
AXIS_NAMES = dict(zip("xyz", NAMES, strict=True))
ONE_TWO_FIVE = [float(f"{digit}e{power}") for power in range(-4, 5) for digit in (1, 2, 5)]  # ticks
GRID = "rgba(128,128,128,0.28)"
LINE_COLOURS = {"link passing": "rgba(128,128,128,0.9)", "engine order": "rgba(190,140,20,0.95)"}
LABEL_WIDTH = 0.045  # of the width of a third of a page, of a name that stands upright
_LONGEST = 48  # characters of a name in a legend
_AXIS = {"gridcolor": GRID, "zerolinecolor": GRID, "linecolor": GRID, "showline": True, "mirror": True}
_LOOKS = go.layout.Template(  # made once: its items are checked, which takes longer than to draw
    layout={
        "font": {"family": "system-ui, sans-serif", "size": 12},
        "title": {"x": 0.0, "xref": "container", "xanchor": "left", "y": 1.0, "yanchor": "top",
                  "pad": {"t": 8, "l": 8}, "font": {"size": 14}},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": "rgba(128,128,128,0.7)", "activecolor": "rgba(128,128,128,1)"},
        "legend": {"orientation": "h", "x": 0.0, "y": 1.0, "yanchor": "bottom", "bgcolor": "rgba(0,0,0,0)"},
        "xaxis": {**_AXIS, "title": {"standoff": 6}},
        "yaxis": {**_AXIS, "title": {"standoff": 4}},
    }
)  # fmt: skip


def mount_colour(index):
    """Return the colour of a mount and its coil by its number."""
    return _MOUNT_COLOURS[index % len(_MOUNT_COLOURS)]


def plain(text):
    """Return a text from a bag so that a figure shows it as it stands, and not too much of it."""
    text = str(text)
    return escape(text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…", quote=False)


def styled(figure, height, title=None):
    """Give a figure its looks; returns it."""
    margin = {"l": 62, "r": 12, "t": 66 if title else 34, "b": 46}
    return figure.update_layout(template=_LOOKS, height=height, title_text=title, margin=margin)


def line(points, name, colour, **options):
    """Return a line through points, a pair of arrays (n,)."""
    style = {"color": colour, "width": options.pop("width", 1.1), "dash": options.pop("dash", "solid")}
    return go.Scatter(x=points[0], y=points[1], name=name, mode="lines", line=style, **options)


def over_frequency(traces, analysis, title, unit):
    """Return a figure of lines over the logarithm of the frequency, known lines of the spectrum marked."""
    figure = styled(go.Figure(traces), 340, title)
    top = 0.5 * analysis.rate
    low, high = log10(LOWEST_FREQUENCY), log10(max(top, 2.0 * LOWEST_FREQUENCY))
    shapes, names = _marks([each for each in analysis.lines if LOWEST_FREQUENCY <= each.frequency <= top], low, high)
    return figure.update_layout(
        xaxis={"type": "log", "range": (low, high), "tickvals": ONE_TWO_FIVE, "title": {"text": "frequency, Hz"}},
        yaxis={"title": {"text": unit}},
        shapes=shapes,
        annotations=names,
    )


def density(traces, analysis, title):
    """Return a figure of power spectral densities."""
    figure = over_frequency(traces, analysis, title, "PSD, (m/s²)²/Hz")
    return figure.update_yaxes(type="log", exponentformat="power", dtick=1)


def ratio(traces, analysis, title):
    """Return a figure of transmissibilities; it shows half to twice at least, so that nothing small looks large."""
    figure = over_frequency(traces, analysis, title, "|H1|, powertrain / chassis")
    values = np.concatenate([trace.y for trace in traces])
    values = values[values > 0.0]  # which leaves nan out, too
    low, high = min(values.min(initial=0.5), 0.5), max(values.max(initial=2.0), 2.0)
    return figure.update_yaxes(type="log", range=(log10(0.9 * low), log10(1.1 * high)), tickvals=ONE_TWO_FIVE)


def coherence(traces, analysis, title):
    """Return a figure of coherences."""
    return over_frequency(traces, analysis, title, "coherence, -").update_yaxes(range=(0.0, 1.02))


def _marks(lines, low, high):
    """Return shapes and names that mark lines of known cause, or the ranges over which they moved.

    Names stand upright: of link passing at the top, of the engine at the bottom.
    """
    shapes, names = [], []
    for kind, colour in LINE_COLOURS.items():
        passing = kind == "link passing"
        kept = [line for line in lines if line.name.startswith(kind)]
        whole = {"y0": 0.0, "y1": 1.0, "yref": "paper", "layer": "below"}
        style = {"type": "line", "line": {"color": colour, "width": 1, "dash": "dot" if passing else "dash"}, **whole}
        range_style = {"type": "rect", "fillcolor": colour, "opacity": 0.2, "line": {"width": 0}, **whole}
        shapes += [
            {"x0": each.lowest, "x1": each.highest, **range_style}
            if each.sweeps
            else {"x0": each.frequency, "x1": each.frequency, **style}
            for each in kept
        ]
        places = [0.5 * log10(line.lowest * line.highest) if line.sweeps else log10(line.frequency) for line in kept]
        for group in joined(places, LABEL_WIDTH * (high - low)):
            numbers = ", ".join(kept[each].name.rpartition(" ")[2] for each in group)
            words = f"order {numbers}" if not passing else "v/p" if numbers == "1" else f"{numbers} v/p"
            names.append(
                {"x": places[group[0]], "y": 1.0 if passing else 0.0, "yref": "paper", "text": words, "textangle": -90,
                 "showarrow": False, "xanchor": "right", "yanchor": "top" if passing else "bottom",
                 "font": {"size": 10}, "borderpad": 0}
            )  # fmt: skip
    return shapes, names


def settling(figure, analysis):
    """Shade the settling time of a figure over time."""
    return figure.add_vrect(x0=0.0, x1=analysis.settle, fillcolor="rgba(128,128,128,0.15)", line_width=0, layer="below")
