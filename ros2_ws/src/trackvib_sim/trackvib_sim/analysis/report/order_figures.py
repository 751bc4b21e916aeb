"""Figures of the engine's orders and Campbell diagrams."""

import numpy as np
import plotly.graph_objects as go

from ..numbers import AXES, SENSORS
from .comparison_figures import overlay
from .figure_style import AXIS_NAMES, LINE_COLOURS, line, mount_colour, styled
from .spectrogram_figures import ends_of, level_map

_ENGINE = ("engine speed", "r/min")
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
    for ray in diagram.rays:
        kind = next(kind for kind in LINE_COLOURS if ray.name.startswith(kind))
        style = {"color": "white", "width": 1.2, "dash": "dot" if kind == "link passing" else "dash"}
        (x, y), (x_end, y_end) = ray.ends
        figure.add_shape(type="line", x0=x, y0=y, x1=x_end, y1=y_end, line=style)
        name = ray.name.removeprefix(f"{kind} ").split(",")[0]
        words = f"order {name}" if kind == "engine order" else "v/p" if name == "1" else f"{name} v/p"
        figure.add_annotation(
            x=x_end, y=y_end, text=words, showarrow=False, xanchor="right", yanchor="bottom",
            font={"size": 10, "color": "white"}, borderpad=0,
        )  # fmt: skip
    return figure.update_yaxes(range=(0.0, float(diagram.frequency[shown][-1])))


def _title(sensor):
    return f"{sensor.capitalize()}, {AXIS_NAMES['z']}"


def _decibels(psd):
    with np.errstate(divide="ignore"):
        return np.maximum(10.0 * np.log10(psd), -300.0).astype(np.float32)
