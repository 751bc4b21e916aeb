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
    ends = ends_of([each.level for _, each in spectrograms])
    return [
        level_map(title, (each.time, "time", "s"), (each.frequency, "frequency", "Hz"), each.level, ends)
        for title, each in spectrograms
    ]


def ends_of(levels):
    """Return the lowest and the highest level [dB] that figures of some arrays of levels tell apart."""
    levels = np.concatenate([each.ravel() for each in levels])
    if not np.isfinite(levels).any():
        return 0.0, 0.0
    return max(np.nanmax(levels) - RANGE, np.nanmin(levels)), np.nanmax(levels)


def level_map(title, across, up, level, ends):
    """Return a figure of levels [dB] (m, n) as colours.

    Parameters
    ----------
    title : str
    across, up : tuple
        Values (n,) and (m,), what they are, and in which unit.
    level : (m, n) array
    ends : tuple
        As `ends_of` returns them.
    """
    bar = {"title": {"text": "dB", "side": "top"}, "thickness": 10, "outlinewidth": 0, "x": 1.0, "xpad": 4}
    (x, x_words, x_unit), (y, y_words, y_unit) = across, up
    figure = go.Figure(
        go.Heatmap(
            x=x,
            y=y,
            z=level,
            zmin=ends[0],
            zmax=ends[1],
            colorscale="Cividis",
            colorbar=bar,
            hovertemplate=f"%{{x:.4~g}} {x_unit}, %{{y:.4~g}} {y_unit}: %{{z:.1f}} dB<extra></extra>",
        )
    )
    styled(figure, 340, title)
    figure.update_layout(margin={"r": 58, "t": 40})
    figure.update_xaxes(title_text=f"{x_words}, {x_unit}", showgrid=False)
    figure.update_yaxes(title_text=", ".join(filter(None, (y_words, y_unit))), showgrid=False)
    return figure
