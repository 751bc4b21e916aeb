"""Pictures of one run."""

import numpy as np
from matplotlib.figure import Figure

from .labels import joined
from .numbers import SENSORS
from .sensor_style import COLOURS, LOWEST_FREQUENCY
from .vibration import psd

# Of lines, and opacity: a broad one below a narrow one is seen, too.
_WIDTHS = {"chassis": (1.8, 0.45), "powertrain": (0.7, 1.0)}
LABEL_WIDTH = 0.011  # of the width of the spectrum, of a label that stands upright
CLOSE = 1.0  # s of the history: of a whole run the curve drawn last would hide the other


def run_picture(prepared, lines, title, path):
    """Draw a second of the vertical of both sensors, and its PSD with `numbers.Line`s of known cause, to a PNG file."""
    figure = Figure(figsize=(13, 9))
    # margins found out by drawing everything once more would take as long as the picture itself
    margins = {"left": 0.06, "right": 0.99, "bottom": 0.06, "top": 0.92, "hspace": 0.22}
    history, spectrum = figure.subplots(2, 1, height_ratios=(1.0, 1.5), gridspec_kw=margins)
    figure.suptitle(title, fontsize=11, parse_math=False)  # names of roads and laws come from outside
    _history(history, prepared)
    _spectrum(spectrum, prepared, lines)
    figure.savefig(path, dpi=110)


def _history(plot, prepared):
    """The second in the middle of what is settled, or what there is of it."""
    settled = prepared.time[prepared.settled] if prepared.settled.any() else prepared.time
    start = max(0.5 * (settled[0] + settled[-1] - CLOSE), prepared.time[0])
    shown = (prepared.time >= start) & (prepared.time <= start + CLOSE)
    for sensor in SENSORS:
        values, (width, alpha) = prepared.limited[sensor][shown, 2], _WIDTHS[sensor]
        plot.plot(prepared.time[shown], values, color=COLOURS[sensor], linewidth=width, alpha=alpha, label=sensor)
    plot.set_xlim(start, start + CLOSE)
    plot.set_xlabel("time, s")
    plot.set_ylabel("m/s²")
    plot.set_title("vertical acceleration at the MR mounts' ends, one second", fontsize=10)
    plot.grid(alpha=0.3)
    plot.legend(loc="upper right", fontsize=8, ncols=2)


def _spectrum(plot, prepared, lines):
    for sensor in SENSORS:
        frequency, density = psd(prepared.raw[sensor][prepared.settled], prepared.rate)
        plot.loglog(frequency[1:], density[1:, 2], color=COLOURS[sensor], linewidth=1.0, label=sensor)
    plot.set_xlim(LOWEST_FREQUENCY, prepared.rate / 2)
    mark_lines(plot, [line for line in lines if line.frequency >= LOWEST_FREQUENCY])
    plot.set_xlabel("frequency, Hz")
    plot.set_ylabel("(m/s²)²/Hz")
    plot.set_title(
        "vertical power spectral density, with link passing (v/p) and engine orders"
        + "; shaded: speed varied" * any(line.sweeps for line in lines),
        fontsize=10,
    )
    plot.grid(alpha=0.3, which="both")
    plot.legend(fontsize=8, loc="upper left")


def mark_lines(plot, lines):
    """Mark lines of known cause, or the ranges over which they moved."""
    low, high = np.log10(plot.get_xlim())
    named = [(line.lowest * line.highest) ** 0.5 if line.sweeps else line.frequency for line in lines]
    for line in lines:
        if line.sweeps:
            plot.axvspan(line.lowest, line.highest, color="0.4", alpha=0.15, linewidth=0.0)
        else:
            plot.axvline(line.frequency, color="0.4", linewidth=0.8, linestyle=":")
    for group in joined(np.log10(named), LABEL_WIDTH * (high - low)):
        plot.text(
            named[group[0]], 0.02, ", ".join(f"{lines[each].name}: {lines[each].hertz} Hz" for each in group),
            transform=plot.get_xaxis_transform(), rotation=90, va="bottom", ha="right", fontsize=7, color="0.25",
        )  # fmt: skip
