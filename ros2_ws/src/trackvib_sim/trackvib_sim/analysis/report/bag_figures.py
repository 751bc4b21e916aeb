"""The figures about one bag: a function each, from its `ReportData`."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from ..numbers import AXES, SENSORS
from .figure_style import (
    AXIS_COLOURS,
    AXIS_NAMES,
    SENSOR_COLOURS,
    coherence,
    density,
    line,
    mount_colour,
    plain,
    ratio,
    settling,
    styled,
)

LONG = 30  # bins, from which levels along the bag tell more than the histories
_DENSITY = ((0.0, "rgba(128,128,128,0.2)"), (1.0, "rgba(128,128,128,0.95)"))


def histories(report_data):
    """Specific force of both sensors along three axes, below each other."""
    figure = make_subplots(rows=3, cols=1, shared_xaxes=True, vertical_spacing=0.03)
    for row, axis in enumerate(AXES, start=1):
        for sensor in SENSORS:
            points = report_data.accelerations[sensor][axis]
            options = {"legendgroup": sensor, "showlegend": row == 1, "opacity": 0.85}
            figure.add_trace(line(points, sensor, SENSOR_COLOURS[sensor], width=0.8, **options), row=row, col=1)
        figure.update_yaxes(title_text=f"{AXIS_NAMES[axis]}, m/s²", row=row, col=1)
    figure.update_xaxes(title_text="time, s", row=3, col=1)
    return settling(styled(figure, 640), report_data.analysis)


def levels(report_data):
    """RMS of the vertical and, if it is known, the speed in equal parts of the bag; None for a short bag."""
    history = report_data.analysis.history
    if len(history.time) < LONG:
        return None
    rows = 2 if np.isfinite(history.speed).any() else 1
    heights = (0.65, 0.35)[:rows]
    figure = make_subplots(rows=rows, cols=1, shared_xaxes=True, vertical_spacing=0.05, row_heights=heights)
    for sensor in SENSORS:
        points = history.time, history.rms[sensor][:, AXES.index("z")]
        figure.add_trace(line(points, sensor, SENSOR_COLOURS[sensor]), row=1, col=1)
    figure.update_yaxes(title_text="RMS vertical z, m/s²", rangemode="tozero", row=1, col=1)
    if rows == 2:
        figure.add_trace(line((history.time, history.speed), "speed", "#808080"), row=2, col=1)
        figure.update_yaxes(title_text="speed, m/s", row=2, col=1)
    figure.update_xaxes(title_text="time, s", row=rows, col=1)
    return settling(styled(figure, 420), report_data.analysis)


def spectra(report_data):
    """Power spectral densities of both sensors: a figure an axis."""
    found = report_data.analysis.spectra
    return [
        density(
            [
                line((found.frequency[1:], found.psd[sensor][1:, column]), sensor, SENSOR_COLOURS[sensor])
                for sensor in SENSORS
            ],
            report_data.analysis,
            AXIS_NAMES[axis],
        )
        for column, axis in enumerate(AXES)
    ]


def transmission(report_data):
    """Transmissibility from chassis to powertrain, and their coherence: a figure each."""
    found = report_data.analysis.spectra

    def traces(values):
        return [
            line((found.frequency[1:], values[1:, column]), AXIS_NAMES[axis], AXIS_COLOURS[axis])
            for column, axis in enumerate(AXES)
        ]

    return [
        ratio(traces(found.transmissibility), report_data.analysis, "Transmissibility"),
        coherence(traces(found.coherence), report_data.analysis, "Coherence"),
    ]


def mount_loops(report_data):
    """Vertical force over deflection and over velocity: a figure a mount each; none without mount states."""
    kinds = ((report_data.deflection_loops, "deflection, mm"), (report_data.velocity_loops, "velocity, m/s"))
    return [
        _loop(loop, name, mount_colour(index), unit)
        for loops, unit in kinds
        for index, (name, loop) in enumerate(loops.items())
    ]


def _loop(loop, name, colour, unit):
    cells = go.Heatmap(
        x=loop.across, y=loop.force, z=loop.density, colorscale=_DENSITY, showscale=False, hoverinfo="skip"
    )
    figure = go.Figure((cells, line(loop.line, "1 s", colour)))
    styled(figure, 340, f"{plain(name.capitalize())} mount, force over {unit.split(',')[0]}")
    figure.update_layout(showlegend=False, margin={"t": 40})
    figure.update_xaxes(title_text=unit, zeroline=False)
    figure.update_yaxes(title_text="force on the powertrain, kN", zeroline=False)
    return figure


def currents(report_data):
    """Demanded current and that in the coils; None if the bag has neither."""
    if not (report_data.demanded or report_data.currents):
        return None
    figure = go.Figure()
    kinds = ((report_data.demanded, "demanded", "dot", 0.6), (report_data.currents, "in the coil", "solid", 1.0))
    for lines, words, dash, opacity in kinds:
        for index, (coil, points) in enumerate(lines.items()):
            name = f"{plain(coil)}, {words}"
            figure.add_trace(line(points, name, mount_colour(index), dash=dash, opacity=opacity))
    figure.update_xaxes(title_text="time, s")
    figure.update_yaxes(title_text="current, A", rangemode="tozero")
    return settling(styled(figure, 300), report_data.analysis)
