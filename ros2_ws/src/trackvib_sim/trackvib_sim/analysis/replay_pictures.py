"""Pictures of what was recorded beside what a replay gave."""

import matplotlib

matplotlib.use("Agg")  # files only: no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from .plots import LOWEST_FREQUENCY, NAMES  # noqa: E402
from .summary import SENSORS  # noqa: E402
from .vibration import psd  # noqa: E402

COLOURS = ("#6b7785", "#c2410c")  # recorded, replayed
SIDES = ("left", "right")


def drives_picture(drives, currents, title, path):
    """Draw vertical histories and spectra of both sensors and the currents of two drives to a PNG file.

    `drives` maps two labels to `summary.Prepared`, `currents` the same to times [s] and currents (k, 2) [A].
    """
    figure = plt.figure(figsize=(13, 9), layout="constrained")
    figure.suptitle(title, fontsize=11)
    histories, spectra = figure.subfigures(1, 2, width_ratios=(1.25, 1.0))
    rows = histories.subplots(3, 1, sharex=True)
    for plot, plot_of_psd, sensor in zip(rows, spectra.subplots(2, 1, sharex=True), SENSORS, strict=False):
        for colour, (label, drive) in zip(COLOURS, drives.items(), strict=True):
            style = {"color": colour, "label": label}
            plot.plot(drive.time, drive.limited[sensor][:, 2], linewidth=0.5, alpha=0.8, **style)
            frequency, density = psd(drive.raw[sensor][drive.settled], drive.rate)
            plot_of_psd.loglog(frequency[1:], density[1:, 2], linewidth=1.0, **style)
        plot.set_ylabel(f"{sensor}, {NAMES[2]}\nm/s²")
        plot.axvspan(drive.time[0], drive.time[np.argmax(drive.settled)], color="0.9", zorder=0, label="settling")
        plot_of_psd.set_xlim(LOWEST_FREQUENCY, drive.rate / 2)
        plot_of_psd.set_title(f"{sensor}: vertical power spectral density", fontsize=10)
        plot_of_psd.set_ylabel("(m/s²)²/Hz")
        plot_of_psd.set_xlabel("frequency, Hz")
    for colour, (label, (time, values)) in zip(COLOURS, currents.items(), strict=True):
        rows[2].plot(time, values.mean(1), color=colour, linewidth=0.7, label=label)
    rows[2].set_ylabel("demanded current,\nmean of both mounts, A")
    rows[2].set_xlabel("time, s")
    _finish(figure, path)


def currents_picture(time, recorded, replayed, title, path):
    """Draw recorded and replayed currents (k, 2) [A] over time [s], and their difference, to a PNG file."""
    figure, rows = plt.subplots(3, 1, figsize=(11, 7.5), sharex=True, layout="constrained")
    figure.suptitle(title, fontsize=11)
    for side, (plot, name) in enumerate(zip(rows, SIDES, strict=False)):
        for colour, values, label in zip(COLOURS, (recorded, replayed), ("recorded", "replayed"), strict=True):
            plot.plot(time, values[:, side], color=colour, linewidth=0.8, label=label)
        rows[2].plot(time, replayed[:, side] - recorded[:, side], linewidth=0.8, label=name)
        plot.set_ylabel(f"{name} coil\ncurrent, A")
    rows[2].set_ylabel("replayed less\nrecorded, A")
    rows[2].set_xlabel("time, s")
    _finish(figure, path)


def _finish(figure, path):
    for plot in figure.get_axes():
        plot.grid(alpha=0.3)
        plot.legend(loc="upper right", fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)
