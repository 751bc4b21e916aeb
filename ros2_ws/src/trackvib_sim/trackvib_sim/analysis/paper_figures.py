"""Pictures that stand beside the figures of [Tao2025]: road, time histories, spectra, levels, and two solvers.

Accelerations in body axes; labels name the paper's axes as well (paper X, Y, Z = x, z, y).
"""

import matplotlib

matplotlib.use("Agg")  # files only: no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from ..road.iso8608 import HIGHEST, LOWEST, roughness  # noqa: E402
from .plots import COLOURS  # noqa: E402
from .vibration import psd  # noqa: E402

AXES = ("longitudinal x (paper X)", "lateral y (paper Z)", "vertical z (paper Y)")
VERTICAL = 2
ZOOM = 0.25  # s, what a close look shows
HIGHEST_DRAWN = 400.0  # Hz, in spectra
CLASS_BOUNDS = 2.0  # a class reaches from half to twice its geometric mean [ISO8608]
SECOND = "black"  # colour of the second solver


def road_picture(path, title, time, height, rate, long_height, road_class, speed):
    """Draw a road profile against time, and its spectrum beside that of its class.

    Parameters
    ----------
    path : path-like
        PNG file to write, as in the other functions.
    title : str
    time : (k,) array
        s.
    height : (2, k) array
        Left and right profile, m.
    rate : float
        Samples a second at `speed` [m/s].
    long_height : (2, m) array
        A longer stretch, of which the spectrum is taken, m.
    road_class : str
    speed : float
    """
    figure, (history, spectrum) = _figure(title, (13, 4.6), 1, 2, width_ratios=(1.5, 1.0))
    sides = zip(("left", "right"), COLOURS.values(), height, long_height, strict=True)
    for side, colour, short, long in sides:
        history.plot(time, 1e3 * short, color=colour, linewidth=1.0, label=side)
        frequency, density = psd(long, rate, 1.0 / 20.0)
        spectrum.loglog(frequency[1:], density[1:], color=colour, linewidth=0.8, alpha=0.8, label=side)
    _label(history, "time, s", "height, mm", "profile")
    history.set_xlim(time[0], time[-1])
    band = speed * np.array((LOWEST, HIGHEST))
    line = roughness(road_class, band / speed) / speed
    spectrum.loglog(band, line, color=SECOND, linewidth=1.5, label=f"ISO 8608, class {road_class}")
    spectrum.fill_between(band, line / CLASS_BOUNDS, line * CLASS_BOUNDS, color="0.85", label="bounds of the class")
    spectrum.set_xlim(0.5 * band[0], 2.0 * band[1])
    spectrum.set_ylim(0.05 * line[1], 20.0 * line[0])
    _label(spectrum, "frequency, Hz", "m²/Hz", "power spectral density of the height")
    _save(figure, path)


def history_picture(path, title, time, force):
    """Draw time histories of three axes: `force` maps a sensor to its accelerations (k, 3) [m/s^2] at `time` (k,)."""
    figure, plots = _figure(title, (14, 8), 3, 3, sharey="row", width_ratios=(1.0, 1.0, 0.8))
    end = time[0] + ZOOM
    for axis, row in enumerate(plots):
        for plot, (sensor, values) in zip(row, force.items(), strict=False):
            plot.plot(time, values[:, axis], color=COLOURS[sensor], linewidth=0.4)
            row[-1].plot(time[time <= end], values[time <= end, axis], color=COLOURS[sensor], linewidth=1.0, label=sensor)
            _label(plot, None, None, sensor if axis == 0 else None)
        _label(row[-1], None, None, f"the first {ZOOM:g} s of both" if axis == 0 else None)
        row[0].set_ylabel(f"{AXES[axis]}\nm/s²")
    for plot in plots[-1]:
        plot.set_xlabel("time, s")
    plots[0, -1].legend(loc="upper right", fontsize=8, ncols=2)
    _save(figure, path)


def spectrum_picture(path, title, rate, force, link_passing, engine_orders):
    """Draw the vertical PSD of both sensors with the lines to expect.

    Parameters
    ----------
    path, title, force
        As above.
    rate : float
        Samples a second, Hz.
    link_passing : float
        Frequency at which track links pass, v/p, Hz.
    engine_orders : dict
        Name of each line of the engine -> its frequency, Hz.
    """
    figure, plot = _figure(title, (12, 6), 1, 1)
    for sensor, values in force.items():
        plot.semilogy(*_vertical(values, rate), color=COLOURS[sensor], linewidth=1.2, label=sensor)
    harmonics = link_passing * np.arange(1, int(HIGHEST_DRAWN / link_passing) + 1)
    for number, frequency in enumerate(harmonics, 1):
        label = f"link passing, {number if number > 1 else ''} v/p\n{frequency:.1f} Hz"
        _mark(plot, frequency, label, "0.35", "--", 0.99)
    for name, frequency in engine_orders.items():
        _mark(plot, frequency, f"{name}\n{frequency:.1f} Hz", "#3f8f4f", ":", 0.88)
    plot.set_xlim(0.0, HIGHEST_DRAWN)
    _label(plot, "frequency, Hz", "(m/s²)²/Hz", None)
    plot.legend(loc="lower right")
    _save(figure, path)


def level_picture(path, title, classes, speeds, levels):
    """Draw RMS accelerations against speed, a line for each road class.

    `levels` maps a sensor to an array (classes, speeds, 3) [m/s^2] with nan where there is none.
    """
    figure, plots = _figure(title, (13, 7.5), len(levels), 3, sharex=True, sharey="col")
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(classes)))
    for row, (sensor, values) in zip(plots, levels.items(), strict=True):
        for axis, plot in enumerate(row):
            for number, (road_class, colour) in enumerate(zip(classes, colours, strict=True)):
                plot.plot(speeds, values[number, :, axis], "osD^v<>p"[number] + "-", color=colour, markersize=5,
                          linewidth=1.2, label=f"class {road_class}")  # fmt: skip
            plot.set_ylim(bottom=0.0)
            plot.set_xticks(speeds)
            _label(plot, None, None, f"{sensor}, {AXES[axis]}")
        row[0].set_ylabel("RMS acceleration, m/s²")
    for plot in plots[-1]:
        plot.set_xlabel("speed, m/s")
    plots[0, 0].legend(fontsize=8)
    _save(figure, path)


def solver_picture(path, title, rate, ours, theirs, levels):
    """Draw the vertical PSD of two runs and the RMS of all axes beside each other.

    `ours` and `theirs` map a sensor to its accelerations (k, 3) [m/s^2]; `levels` maps the name of each of the two
    solvers to a dict of sensor -> RMS (3,) [m/s^2].
    """
    figure = plt.figure(figsize=(14, 7), layout="constrained")
    figure.suptitle(title, fontsize=11)
    left, right = figure.subfigures(1, 2, width_ratios=(1.6, 1.0))
    names = list(levels)
    for plot, sensor in zip(left.subplots(2, 1, sharex=True), ours, strict=True):
        plot.semilogy(*_vertical(ours[sensor], rate), color=COLOURS[sensor], linewidth=2.5, label=names[0])
        plot.semilogy(*_vertical(theirs[sensor], rate), color=SECOND, linewidth=0.9, linestyle="--", label=names[1])
        _label(plot, "frequency, Hz", "(m/s²)²/Hz", f"{sensor}, vertical power spectral density")
        plot.set_xlim(0.0, HIGHEST_DRAWN)
        plot.legend(fontsize=9)
    bars, places, width = right.subplots(), np.arange(3.0), 0.2
    for number, sensor in enumerate(ours):
        for name, shift, look in zip(names, (-0.5, 0.5), ({}, {"hatch": "///", "edgecolor": "white"}), strict=True):
            at = places + width * (2.0 * number - 1.0 + shift)
            drawn = bars.bar(at, levels[name][sensor], width, color=COLOURS[sensor], label=f"{sensor}, {name}", **look)
            bars.bar_label(drawn, fmt="%.3f", fontsize=7, rotation=90, padding=3)
    bars.set_xticks(places, [axis.replace(" (", "\n(") for axis in AXES], fontsize=9)
    bars.margins(y=0.12)
    _label(bars, None, "m/s²", "RMS acceleration")
    bars.legend(fontsize=8, loc="upper left")
    _save(figure, path)


def _figure(title, size, *shape, **sharing):
    figure, plots = plt.subplots(*shape, figsize=size, layout="constrained", **sharing)
    figure.suptitle(title, fontsize=11)
    return figure, plots


def _label(plot, x, y, title):
    plot.set(xlabel=x, ylabel=y)
    plot.set_title(title, fontsize=10)
    plot.grid(alpha=0.3)
    if plot.get_legend_handles_labels()[0]:
        plot.legend(fontsize=8)


def _vertical(values, rate):
    frequency, density = psd(values[:, VERTICAL], rate)
    return frequency[1:], density[1:]


def _mark(plot, frequency, label, colour, style, height):
    plot.axvline(frequency, color=colour, linestyle=style, linewidth=0.9, zorder=0)
    plot.text(frequency, height, f" {label}", color=colour, fontsize=7.5, va="top", transform=plot.get_xaxis_transform())


def _save(figure, path):
    figure.savefig(path, dpi=110)
    plt.close(figure)
