"""Pictures of what was recorded beside what a replay gave."""

import numpy as np
from matplotlib.figure import Figure

from .numbers import SENSORS
from .sensor_style import LOWEST_FREQUENCY, NAMES
from .vibration import psd

COLOURS = ("#6b7785", "#c2410c")  # recorded, replayed
COIL_COLOURS = ("#1d5fa8", "#c98a00", "#2f7f3f", "#a03f8f")
_DASHES = ("-", "--", ":", "-.")
PART = 0.5  # s, of which levels are drawn: of samples the last curve drawn would hide the others
CLOSE = 1.0  # s that are drawn close up


def drives_picture(drives, currents, title, path):
    """Draw vertical levels and spectra of both sensors and the currents of two drives to a PNG file.

    `drives` maps two labels to `summary.Prepared`, `currents` the same to times [s] and currents (k, coils) [A].
    """
    figure = Figure(figsize=(13, 9), layout="constrained")
    histories, spectra = figure.subfigures(1, 2, width_ratios=(1.25, 1.0))
    rows = histories.subplots(3, 1, sharex=True)
    for plot, plot_of_psd, sensor in zip(rows, spectra.subplots(2, 1, sharex=True), SENSORS, strict=False):
        for colour, (label, drive) in zip(COLOURS, drives.items(), strict=True):
            width = max(round(PART * drive.rate), 1)
            time, squares = _parts(drive.time, width), _parts(drive.limited[sensor][:, 2] ** 2, width)
            plot.plot(time.mean(1), np.sqrt(squares.mean(1)), color=colour, linewidth=1.2, label=label)
            frequency, density = psd(drive.raw[sensor][drive.settled], drive.rate)
            plot_of_psd.loglog(frequency[1:], density[1:, 2], linewidth=1.0, color=colour)
        plot.axvspan(0.0, drive.time[np.argmax(drive.settled)], color="0.9", zorder=0, label="settling")
        plot.set_ylabel(f"{sensor}, {NAMES[2]}:\nRMS of each {PART:g} s, m/s²")
        plot.set_ylim(bottom=0.0)
        plot_of_psd.set_xlim(LOWEST_FREQUENCY, drive.rate / 2)
        plot_of_psd.set_title(f"{sensor}: vertical power spectral density", fontsize=10)
        plot_of_psd.set_ylabel("(m/s²)²/Hz")
        plot_of_psd.set_xlabel("frequency, Hz")
    for colour, (time, values) in zip(COLOURS, currents.values(), strict=True):
        if len(time):
            width = max(round(PART * len(time) / max(time[-1] - time[0], PART)), 1)
            time, mean = _parts(time, width).mean(1), _parts(values.mean(1), width)
            rows[2].fill_between(time, mean.min(1), mean.max(1), color=colour, alpha=0.2, linewidth=0.0)
            rows[2].plot(time, mean.mean(1), color=colour, linewidth=1.2)
    rows[2].set_ylabel(f"demanded current, all coils:\nmean and range of each {PART:g} s, A")
    rows[2].set_xlabel("time, s")
    _finish(figure, title, rows[0], path)


def currents_picture(time, recorded, replayed, names, title, path):
    """Draw recorded and replayed currents (k, coils) [A] over time [s], and their difference, to a PNG file.

    All of it on the left, on the right the second about the greatest difference.
    """
    figure = Figure(figsize=(13, 7.5), layout="constrained")
    rows = figure.subplots(3, 2, sharex="col", sharey="row", width_ratios=(1.6, 1.0))
    difference = replayed - recorded
    middle = time[np.argmax(np.abs(difference).max(axis=1))]
    begin = max(min(middle - CLOSE / 2, time[-1] - CLOSE), time[0])
    for plots, values in zip(rows, (recorded.T, replayed.T, difference.T), strict=True):
        for plot in plots:
            for index, (each, name) in enumerate(zip(values, names, strict=False)):  # a coil is called as its mount
                colour, dash = COIL_COLOURS[index % len(COIL_COLOURS)], _DASHES[(index + index // 4) % len(_DASHES)]
                style = {"color": colour, "linestyle": dash, "linewidth": 0.9, "drawstyle": "steps-post"}
                plot.plot(time, each, label=f"{name} coil", **style)
    for (plot, _), words in zip(rows, ("recorded, A", "replayed, A", "replayed minus\nrecorded, A"), strict=True):
        plot.set_ylabel(words)
    rows[1, 0].sharey(rows[0, 0])
    rows[0, 0].autoscale()
    rows[0, 1].set_title(f"{CLOSE:g} s about the greatest difference", fontsize=10)
    rows[2, 1].set_xlim(begin, begin + CLOSE)
    for plot in rows[2]:
        plot.set_xlabel("time, s")
    _finish(figure, title, rows[0, 0], path)


def _parts(values, width):
    """Return samples (k,) as rows of a width; what is left over at the end is left out, unless it is all there is."""
    width = min(width, len(values))
    return values[: len(values) // width * width].reshape(-1, width)


def _finish(figure, title, legend_of, path):
    figure.suptitle(title, fontsize=11, parse_math=False)
    for plot in figure.get_axes():
        plot.grid(alpha=0.3)
    legend = figure.legend(*legend_of.get_legend_handles_labels(), loc="outside upper right", ncols=3, fontsize=9)
    for text in legend.get_texts():
        text.set_parse_math(False)  # names of bags, laws and mounts come from outside
    figure.savefig(path, dpi=110)
