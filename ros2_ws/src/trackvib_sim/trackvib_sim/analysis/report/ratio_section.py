"""The section of a report that sets a measured drive beside a simulated one, by ratios."""

from math import isnan

import plotly.graph_objects as go

from ..comparison.compare import THROUGH
from ..numbers import AXES
from .figure_style import AXIS_NAMES, LINE_COLOURS, ONE_TWO_FIVE, SENSOR_COLOURS, styled
from .sections import Section
from .tables import Table, number

_COLOURS = {**SENSOR_COLOURS, THROUGH: "#b0508f"}
_METHOD = (
    "Ratios are simulated over measured, with {confidence:.0%} confidence intervals. These come from the jackknife "
    "over groups of windows (2 s, Hann, 50 % overlap; {windows[0]} measured, {windows[1]} simulated) and Student's t "
    "on logarithms, with degrees of freedom by Welch and Satterthwaite. {aligned} The first {settle[0]:.4g} s of the "
    "measured drive and the first {settle[1]:.4g} s of the simulated one do not count."
)
_ALIGNED = {
    "speed": "Windows are compared in the speed bands that both drives contain, weighted as in the measured drive.",
    "distance": "Windows are compared in the distance intervals that both drives contain.",
    "none": "The drives are not aligned: statistics of all time that counts.",
}


def ratio_section(comparison):
    """Return the `sections.Section` about a `Comparison`."""
    words = _METHOD.format(
        confidence=comparison.confidence,
        windows=comparison.windows,
        aligned=_ALIGNED[comparison.aligned_by],
        settle=comparison.settle,
    )
    figures = [_thirds(comparison, axis) for axis in AXES]
    return Section("Simulated over measured", words, figures, [ratio_table(comparison)], 3)


def ratio_table(comparison):
    """Return the `tables.Table` of the ratios of levels of a `Comparison`, without those by third octave."""
    rows = [
        (
            f"{each.part} {each.axis}",
            each.quantity,
            "" if isnan(each.frequency) else f"{each.frequency:.4g}",
            *(number(value, 3) for value in (each.measured, each.simulated, each.ratio)),
            "–" if isnan(each.low) else f"{number(each.low, 3)} to {number(each.high, 3)}",
        )
        for each in comparison.ratios
        if "third octave" not in each.quantity
    ]
    head = ("", "m/s²", "Hz", "measured", "simulated", "ratio", f"{comparison.confidence:.0%} interval")
    return Table(head, rows, 2)


def _thirds(comparison, axis):
    """Ratios by third octave along an axis, with their intervals."""
    figure = go.Figure()
    for part, colour in _COLOURS.items():
        found = [
            each
            for each in comparison.ratios
            if (each.part, each.axis) == (part, axis) and "third octave" in each.quantity and not isnan(each.ratio)
        ]
        if found:
            up = [0.0 if isnan(each.high) else each.high - each.ratio for each in found]
            down = [0.0 if isnan(each.low) else each.ratio - each.low for each in found]
            figure.add_trace(
                go.Scatter(
                    x=[each.frequency for each in found],
                    y=[each.ratio for each in found],
                    error_y={"type": "data", "array": up, "arrayminus": down, "thickness": 1, "width": 2},
                    mode="lines+markers",
                    marker_size=4,
                    line={"color": colour, "width": 1.1},
                    name="transmissibility" if part == THROUGH else part,
                )
            )
    styled(figure, 380, f"Ratio by third octave, {AXIS_NAMES[axis]}")
    figure.add_hline(1.0, line={"color": LINE_COLOURS["link passing"], "width": 1, "dash": "dot"})
    figure.update_xaxes(type="log", tickvals=ONE_TWO_FIVE, title_text="frequency, Hz")
    return figure.update_yaxes(type="log", tickvals=ONE_TWO_FIVE, title_text="simulated / measured")
