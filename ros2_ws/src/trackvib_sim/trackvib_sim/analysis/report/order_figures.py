"""Figures of the engine's orders and Campbell diagrams."""

import numpy as np
import plotly.graph_objects as go

from ..labels import Box, first_free
from ..numbers import AXES, SENSORS
from .comparison_figures import overlay
from .figure_style import AXIS_NAMES, line, mount_colour, styled
from .spectrogram_figures import ends_of, level_map

_ENGINE = ("engine speed", "r/min")
_CHARACTER = 0.014, 0.042  # of width and height of a Campbell diagram, of a character of a name
_SHIFTS = np.linspace(0.0, 0.9, 19)  # parts of a ray by which a name may be moved back from its end
ABOVE = 1.25  # times the highest ray in a Campbell diagram, which ends there


def of_sensors(analysis):
    """Order spectrogram and levels of each order of one bag: a figure a sensor each; none without order tracking."""
    spectra = analysis.order_spectra
    if spectra is None:
        return []
    levels = {sensor: _decibels(psd[:, :, AXES.index("z")].T) for sensor, psd in spectra.psd.items()}
    ends = ends_of(levels.values())
    maps = [
        level_map(_title(sensor), (spectra.engine_speed, *_ENGINE), (spectra.order, "order", ""), levels[sensor], ends)
        for sensor in SENSORS
    ]
    orders = dict.fromkeys(level.order for level in analysis.order_levels)
    lines = [
        _over_engine_speed(
            [
                line(_levels_of(analysis, order, sensor), f"order {order:g}", mount_colour(index))
                for index, order in enumerate(orders)
            ],
            _title(sensor),
        )
        for sensor in SENSORS
        if orders
    ]
    return [*maps, *lines]


def of_powertrains(report_data_list, names):
    """Level of each order of the powertrain in several bags: a figure an order that any of them has."""
    orders = dict.fromkeys(level.order for each in report_data_list for level in each.analysis.order_levels)
    return [
        _over_engine_speed(
            overlay(report_data_list, names, lambda each, o=order: _levels_of(each.analysis, o, "powertrain")),
            f"Order {order:g}",
        )
        for order in orders
    ]


def _levels_of(analysis, order, sensor):
    found = [level for level in analysis.order_levels if level.order == order]
    return [level.engine_speed for level in found], [level.rms[sensor]["z"] for level in found]


def _over_engine_speed(traces, title):
    figure = styled(go.Figure(traces), 320, title)
    figure.update_xaxes(title_text=", ".join(_ENGINE))
    figure.update_yaxes(title_text="RMS, m/s²", rangemode="tozero")
    return figure


def campbells(analysis):
    """Campbell diagrams of one bag: a figure a speed that varies and a sensor."""
    return [_campbell(diagram, sensor) for diagram in analysis.campbell for sensor in SENSORS]


def _campbell(diagram, sensor):
    highest = max((end[1] for ray in diagram.rays for end in ray.ends), default=np.inf)
    shown = diagram.frequency <= ABOVE * highest
    levels = {name: _decibels(psd[:, shown].T) for name, psd in diagram.psd.items()}
    up = diagram.frequency[shown], "frequency", "Hz"
    across = diagram.value, diagram.over, diagram.unit
    figure = level_map(_title(sensor), across, up, levels[sensor], ends_of(levels.values()))
    half = 0.5 * (diagram.value[1] - diagram.value[0])
    across = float(diagram.value[0] - half), float(diagram.value[-1] + half)
    top, taken = float(diagram.frequency[shown][-1]), []
    for ray in diagram.rays:
        figure.add_trace(_ray(ray))
        _name(figure, ray, across, top, taken)
    figure.update_xaxes(range=across)
    figure.update_yaxes(range=(0.0, top))
    return figure.update_layout(height=420, showlegend=False)


def _ray(ray):
    x, y = zip(*ray.ends, strict=True)
    return go.Scatter(
        x=x,
        y=y,
        mode="lines",
        line={"color": "rgba(255,255,255,0.75)", "width": 1, "dash": "dot" if _passing(ray) else "dash"},
        hovertemplate=f"{ray.name}: %{{x:.4~g}}, %{{y:.4~g}} Hz<extra></extra>",
    )


def _passing(ray):
    return ray.name.startswith("link passing")


def _name(figure, ray, across, top, taken):
    """Write the name of a `Ray` at the last place on it that is free; one without a free place has it on hovering."""
    name, _, gear = ray.name.partition(", ")
    number = name.rpartition(" ")[2]
    words = f"order {number}" if not _passing(ray) else "v/p" if number == "1" else f"{number} v/p"
    words = ", ".join(filter(None, (words, gear)))
    (x, y), (x_end, y_end) = ray.ends
    width, height = _CHARACTER[0] * len(words) * (across[1] - across[0]), _CHARACTER[1] * top
    right = np.minimum(x_end, across[1]) - _SHIFTS * (x_end - x)
    bottom = y + (y_end - y) * (right - x) / ((x_end - x) or 1.0)
    boxes = [Box(a - width, b, a, b + height) for a, b in zip(right, bottom, strict=True) if a - width >= across[0]]
    box = first_free(boxes, taken)
    if box is not None:
        taken.append(box)
        place = {"x": [box.right], "y": [box.bottom], "textposition": "top left", "hoverinfo": "skip"}
        figure.add_trace(go.Scatter(mode="text", text=[words], textfont={"size": 10, "color": "white"}, **place))


def _title(sensor):
    return f"{sensor.capitalize()}, {AXIS_NAMES['z']}"


def _decibels(psd):
    with np.errstate(divide="ignore"):
        return np.maximum(10.0 * np.log10(psd), -300.0).astype(np.float32)
