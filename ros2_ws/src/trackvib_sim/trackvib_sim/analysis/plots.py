"""Pictures of one run."""

from matplotlib.figure import Figure

from .numbers import SENSORS
from .sensor_style import COLOURS, LOWEST_FREQUENCY
from .vibration import psd

# Of lines, and opacity: a broad one below a narrow one is seen, too.
_WIDTHS = {"chassis": (1.8, 0.45), "powertrain": (0.7, 1.0)}
CLOSE = 1.0  # s of the history: of a whole run the curve drawn last would hide the other


def run_picture(prepared, lines, title, path):
    """Draw a second of the vertical of both sensors, and its PSD with `numbers.Line`s of known cause, to a PNG file."""
    figure = Figure(figsize=(13, 9), layout="constrained")
    history, spectrum = figure.subplots(2, 1, height_ratios=(1.0, 1.5))
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
    for line in lines:
        side = "left" if line.name.startswith("link") else "right"  # of its line, for a link's and an order's lie close
        plot.axvline(line.frequency, color="0.4", linewidth=0.8, linestyle=":")
        plot.text(
            line.frequency, 0.02, f"{line.name}: {line.frequency:.1f} Hz", transform=plot.get_xaxis_transform(),
            rotation=90, va="bottom", ha=side, fontsize=7, color="0.25",
        )  # fmt: skip
    plot.set_xlim(LOWEST_FREQUENCY, prepared.rate / 2)
    plot.set_xlabel("frequency, Hz")
    plot.set_ylabel("(m/s²)²/Hz")
    plot.set_title("vertical power spectral density, with lines of link passing (v/p) and engine orders", fontsize=10)
    plot.grid(alpha=0.3, which="both")
    plot.legend(fontsize=8, loc="upper left")
