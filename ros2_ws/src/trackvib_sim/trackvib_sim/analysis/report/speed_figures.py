"""Figures of levels along the way and by speed, of one bag and of several."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from ..absorbed_power import RIDE_LIMIT
from ..numbers import SENSORS
from .comparison_figures import overlay
from .figure_style import SENSOR_COLOURS, line, styled

_DISTANCE = "distance, m"
_SPEED = "speed, m/s"


def by_way(analysis):
    """RMS, absorbed power and speed over the way; None of a bag with less than two intervals."""
    if len(analysis.by_way) < 2:
        return None
    figure = _levels(analysis.by_way, _DISTANCE, 3)
    figure.add_trace(line(_stairs(analysis.by_way, lambda part: part.speed), "speed", "#808080"), row=3, col=1)
    figure.update_yaxes(title_text=_SPEED, row=3, col=1)
    return styled(figure, 560)


def by_speed(analysis):
    """RMS and absorbed power in bands of speed; None of a bag with less than two."""
    return styled(_levels(analysis.by_speed, _SPEED, 2), 420) if len(analysis.by_speed) > 1 else None


def _levels(parts, across, rows):
    """Return a figure of so many rows, the first of vertical RMS, the second of absorbed power."""
    figure = make_subplots(rows=rows, cols=1, shared_xaxes=True, vertical_spacing=0.05)
    kinds = (
        ("RMS, m/s²", lambda part, sensor: part.rms[sensor]["z"]),
        ("absorbed, W", lambda part, sensor: part.absorbed_power[sensor]),
    )
    for row, (words, value) in enumerate(kinds, 1):
        for sensor in SENSORS:
            points = _stairs(parts, lambda part, s=sensor, v=value: v(part, s))
            options = {"legendgroup": sensor, "showlegend": row == 1}
            figure.add_trace(line(points, sensor, SENSOR_COLOURS[sensor], **options), row=row, col=1)
        figure.update_yaxes(title_text=words, rangemode="tozero", row=row, col=1)
    if max(part.absorbed_power[sensor] for part in parts for sensor in SENSORS) > RIDE_LIMIT / 3.0:
        figure.add_hline(RIDE_LIMIT, line={"color": "rgba(128,128,128,0.9)", "width": 1, "dash": "dot"}, row=2, col=1)
    figure.update_xaxes(title_text=across, row=rows, col=1)
    return figure


def along_ways(report_data_list, names):
    """RMS over the way: a figure a sensor; none of bags that all have less than two intervals."""
    return _compared(report_data_list, names, "by_way", _DISTANCE)


def by_speeds(report_data_list, names):
    """RMS in bands of speed: a figure a sensor; none of bags that all have less than two bands."""
    return _compared(report_data_list, names, "by_speed", _SPEED)


def _compared(report_data_list, names, kind, across):
    if all(len(getattr(each.analysis, kind)) < 2 for each in report_data_list):
        return []
    figures = []
    for sensor in reversed(SENSORS):
        traces = overlay(
            report_data_list,
            names,
            lambda each, s=sensor: _stairs(getattr(each.analysis, kind), lambda part: part.rms[s]["z"]),
        )
        figure = styled(go.Figure(traces), 320, f"{sensor.capitalize()}, vertical z")
        figure.update_xaxes(title_text=across)
        figure.update_yaxes(title_text="RMS, m/s²", rangemode="tozero")
        figures.append(figure)
    return figures


def _stairs(parts, value):
    """Return the line that keeps a value from the low to the high end of each part, broken where parts are missing."""
    across, up = [], []
    for k, part in enumerate(parts):
        if k and part.low != parts[k - 1].high:
            across.append(part.low)
            up.append(np.nan)
        across += [part.low, part.high]
        up += [value(part)] * 2
    return np.array(across), np.array(up)
