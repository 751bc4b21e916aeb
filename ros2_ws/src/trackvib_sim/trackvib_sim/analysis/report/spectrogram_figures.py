"""Figures of spectrograms: of the sensors of one bag, or of one sensor in several bags."""

import numpy as np
import plotly.graph_objects as go

from ..numbers import SENSORS
from .figure_style import AXIS_NAMES, plain, styled

RANGE = 50.0  # dB below the greatest level of all that are told apart


def of_sensors(report_data):
    """Vertical power spectral density over time of one bag: a figure a sensor."""
    found = report_data.spectrograms
    return _figures([(f"{sensor.capitalize()}, {AXIS_NAMES['z']}", found[sensor]) for sensor in SENSORS])


def of_powertrains(report_data_list, names):
    """The same of the powertrain in several bags: a figure a bag."""
    return _figures(
        [
            (plain(name), report_data.spectrograms["powertrain"])
            for report_data, name in zip(report_data_list, names, strict=True)
        ]
    )


def _figures(spectrograms):
    """Return a figure for each pair of title and `Spectrogram`, all in the same colours."""
    levels = np.concatenate([each.level.ravel() for _, each in spectrograms])
    top = np.nanmax(levels) if np.isfinite(levels).any() else 0.0
    low = max(top - RANGE, np.nanmin(levels) if np.isfinite(levels).any() else 0.0)
    return [_figure(title, each, low, top) for title, each in spectrograms]


def _figure(title, spectrogram, low, top):
    bar = {"title": {"text": "dB", "side": "top"}, "thickness": 10, "outlinewidth": 0, "x": 1.0, "xpad": 4}
    figure = go.Figure(
        go.Heatmap(
            x=spectrogram.time,
            y=spectrogram.frequency,
            z=spectrogram.level,
            zmin=low,
            zmax=top,
            colorscale="Cividis",
            colorbar=bar,
            hovertemplate="%{x:.2f} s, %{y:.0f} Hz: %{z:.1f} dB<extra></extra>",
        )
    )
    styled(figure, 340, title)
    figure.update_layout(margin={"r": 58, "t": 40})
    figure.update_xaxes(title_text="time, s", showgrid=False)
    figure.update_yaxes(title_text="frequency, Hz", showgrid=False)
    return figure
