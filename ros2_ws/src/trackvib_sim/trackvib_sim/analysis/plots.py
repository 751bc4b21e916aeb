"""Pictures of one run."""

import matplotlib

matplotlib.use("Agg")  # files only: no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from .numbers import AXES, SENSORS  # noqa: E402
from .sensor_style import COLOURS, LOWEST_FREQUENCY, NAMES  # noqa: E402
from .vibration import psd  # noqa: E402


def run_picture(prepared, title, path):
    """Draw time histories of three axes and the vertical PSD of both sensors to a PNG file."""
    figure = plt.figure(figsize=(13, 7.5), layout="constrained")
    figure.suptitle(title, fontsize=11, parse_math=False)  # names of roads and laws come from outside
    histories, spectrum = figure.subfigures(1, 2, width_ratios=(1.25, 1.0))
    _histories(histories, prepared)
    _spectrum(spectrum.subplots(), prepared)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _histories(figure, prepared):
    axes = figure.subplots(len(AXES), 1, sharex=True)
    for column, (plot, name) in enumerate(zip(axes, NAMES, strict=True)):
        for sensor in SENSORS:
            plot.plot(
                prepared.time,
                prepared.limited[sensor][:, column],
                color=COLOURS[sensor],
                linewidth=0.5,
                alpha=0.8,
                label=sensor,
            )
        plot.set_ylabel(f"{name}\nm/s²")
        plot.grid(alpha=0.3)
        start = prepared.time[np.argmax(prepared.settled)]
        plot.axvspan(prepared.time[0], start, color="0.9", zorder=0, label="settling" if column == 0 else None)
    axes[0].legend(loc="upper right", fontsize=8, ncols=3)
    axes[0].set_title("acceleration at the MR mounts' ends", fontsize=10)
    axes[-1].set_xlabel("time, s")
    axes[-1].set_xlim(prepared.time[0], prepared.time[-1])


def _spectrum(plot, prepared):
    for sensor in SENSORS:
        frequency, density = psd(prepared.raw[sensor][prepared.settled], prepared.rate)
        plot.loglog(frequency[1:], density[1:, 2], color=COLOURS[sensor], linewidth=1.0, label=sensor)
    plot.set_xlim(LOWEST_FREQUENCY, prepared.rate / 2)
    plot.set_xlabel("frequency, Hz")
    plot.set_ylabel("(m/s²)²/Hz")
    plot.set_title("vertical power spectral density", fontsize=10)
    plot.grid(alpha=0.3, which="both")
    plot.legend(fontsize=8)
