"""Pictures that stand beside the figures of [Tao2025]: road, time histories, spectra, levels, and two solvers.

Accelerations in body axes; labels name the paper's axes as well (paper X, Y, Z = x, z, y).
"""

from itertools import pairwise, product

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from ...analysis.sensor_style import COLOURS
from ...analysis.vibration import psd
from ...road.iso8608 import HIGHEST, LOWEST, SPACING, roughness_of

AXES = ("longitudinal x (paper X)", "lateral y (paper Z)", "vertical z (paper Y)")
VERTICAL = 2
ROAD_TIME = 10.0  # s of a road that are drawn
ROAD_LENGTH = 2000.0  # m of a road of which the spectrum is taken
ZOOM = 0.25  # s, what a close look shows
HIGHEST_DRAWN = 500.0  # Hz, in spectra
CLASS_BOUNDS = 2.0  # a class reaches from half to twice its geometric mean [ISO8608]
SECOND = "black"  # colour of the second solver


def road_picture(file, title, road, speed):
    """Draw the profile of a road as it comes at a speed, and its spectrum beside that of its class, to a PNG file.

    Parameters
    ----------
    file : path-like or binary file
    title : str
    road : road.iso8608.Iso8608Road
        Rough from distance 0 on.
    speed : float
        m/s.
    """
    rate = speed / SPACING  # samples a second
    height = road.heights(0, int(ROAD_LENGTH / SPACING))
    drawn = int(ROAD_TIME * rate)
    band = speed * np.array((LOWEST, HIGHEST))
    figure, (history, spectrum) = _figure(title, (13, 4.6), 1, 2, width_ratios=(1.5, 1.0))
    for side, colour, profile in zip(("left", "right"), COLOURS.values(), height, strict=True):
        history.plot(np.arange(drawn) / rate, 1e3 * profile[:drawn], color=colour, linewidth=1.0, label=side)
        bands = _third_octaves(profile, rate, band)
        spectrum.loglog(*bands, "o-", color=colour, markersize=4, linewidth=0.8, label=side)
    _label(history, "time, s", "height, mm", "profile")
    history.set_xlim(0.0, ROAD_TIME)
    history.legend()
    # G_d(f) = G_d(n) / v with f = n v
    line = roughness_of(road.roughness).psd(band / speed) / speed
    spectrum.loglog(band, line, color=SECOND, linewidth=1.5, label=f"ISO 8608, class {road.roughness}")
    spectrum.fill_between(band, line / CLASS_BOUNDS, line * CLASS_BOUNDS, color="0.85", label="bounds of the class")
    _label(spectrum, "frequency, Hz", "m²/Hz", "power spectral density of the height, third-octave bands")
    spectrum.legend()
    _save(figure, file)


def history_picture(file, title, time, force):
    """Draw time histories of three axes: `force` maps a sensor to its accelerations (k, 3) [m/s^2] at `time` (k,)."""
    figure, plots = _figure(title, (14, 8), 3, 3, sharey="row", width_ratios=(1.0, 1.0, 0.8))
    close = time <= time[0] + ZOOM
    for axis, row in enumerate(plots):
        for plot, (sensor, values) in zip(row, force.items(), strict=False):
            plot.plot(time, values[:, axis], color=COLOURS[sensor], linewidth=0.4)
            row[-1].plot(time[close], values[close, axis], color=COLOURS[sensor], linewidth=1.0, label=sensor)
            _label(plot, None, None, sensor if axis == 0 else None)
        _label(row[-1], None, None, f"the first {ZOOM:g} s of both" if axis == 0 else None)
        row[0].set_ylabel(f"{AXES[axis]}\nm/s²")
    for plot in plots[-1]:
        plot.set_xlabel("time, s")
    plots[0, -1].legend(fontsize=8)
    _save(figure, file)


def spectrum_picture(file, title, rate, force, link_passing, engine_orders):
    """Draw the vertical PSD of both sensors with the lines to expect.

    Parameters
    ----------
    file, title, force
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
        label = f"link passing {number if number > 1 else ''}v/p\n{frequency:.1f} Hz"
        _mark(plot, frequency, label, "0.35", "--", "left")
    for name, frequency in engine_orders.items():
        _mark(plot, frequency, f"{name}\n{frequency:.1f} Hz", "#2f7f3f", ":", "right")
    plot.set_xlim(0.0, HIGHEST_DRAWN)
    plot.set_ylim(top=5.0 * plot.get_ylim()[1])  # room for the names of the lines
    _label(plot, "frequency, Hz", "(m/s²)²/Hz", None)
    plot.legend(loc="lower right")
    _save(figure, file)


def level_picture(file, title, classes, speeds, levels):
    """Draw RMS accelerations against speed, a line for each road class.

    `levels` maps a sensor to an array (classes, speeds, 3) [m/s^2] with nan where there is none.
    """
    figure, plots = _figure(title, (13, 7.5), len(levels), 3, sharex=True, sharey="col")
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(classes)))
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
    _save(figure, file)


def solver_picture(file, title, rate, force, levels):
    """Draw the vertical PSD of the runs of two solvers and the RMS of all axes beside each other.

    `force` maps a solver to a dict of sensor -> accelerations (k, 3) [m/s^2], `levels` likewise to RMS values (3,).
    """
    figure = Figure(figsize=(14, 7), layout="constrained")
    figure.suptitle(title, fontsize=11)
    left, right = figure.subfigures(1, 2, width_ratios=(1.6, 1.0))
    first, second = force
    for plot, sensor in zip(left.subplots(2, 1, sharex=True), force[first], strict=True):
        plot.semilogy(*_vertical(force[first][sensor], rate), color=COLOURS[sensor], linewidth=2.5, label=first)
        plot.semilogy(*_vertical(force[second][sensor], rate), "--", color=SECOND, linewidth=0.9, label=second)
        _label(plot, "frequency, Hz", "(m/s²)²/Hz", f"{sensor}, vertical power spectral density")
        plot.set_xlim(0.0, HIGHEST_DRAWN)
        plot.legend(fontsize=9)
    bars, places, width = right.subplots(), np.arange(3.0), 0.2
    looks = {first: {}, second: {"hatch": "///", "edgecolor": "white"}}
    pairs = product(force[first], looks.items())
    for shift, (sensor, (solver, look)) in zip((-1.5, -0.5, 0.5, 1.5), pairs, strict=True):
        values, label = levels[solver][sensor], f"{sensor}, {solver}"
        drawn = bars.bar(places + width * shift, values, width, color=COLOURS[sensor], label=label, **look)
        bars.bar_label(drawn, fmt="%.3f", fontsize=7, rotation=90, padding=3)
    bars.set_xticks(places, [axis.replace(" (", "\n(") for axis in AXES], fontsize=9)
    bars.margins(y=0.22)  # room for the legend
    _label(bars, None, "m/s²", "RMS acceleration")
    bars.legend(fontsize=8, loc="upper center", ncols=2)
    _save(figure, file)


def _figure(title, size, *shape, **sharing):
    figure = Figure(figsize=size, layout="constrained")
    plots = figure.subplots(*shape, **sharing)
    figure.suptitle(title, fontsize=11)
    return figure, plots


def _label(plot, x, y, title):
    plot.set(xlabel=x, ylabel=y)
    plot.set_title(title, fontsize=10)
    plot.grid(alpha=0.3)
    plot.set_axisbelow(True)


def _vertical(values, rate):
    frequency, density = psd(values[:, VERTICAL], rate)
    return frequency[1:], density[1:]


def _third_octaves(values, rate, band):
    """Return centres [Hz] and mean PSD of the third-octave bands within a band (low, high) [Hz], as in [ISO8608]."""
    frequency, density = psd(values, rate, 0.2 * band[0])
    edges = band[0] * 2.0 ** (np.arange(int(3.0 * np.log2(band[1] / band[0])) + 1) / 3.0)
    parts = [density[(low <= frequency) & (frequency < high)].mean() for low, high in pairwise(edges)]
    return np.sqrt(edges[:-1] * edges[1:]), parts


def _mark(plot, frequency, label, colour, style, side):
    plot.axvline(frequency, color=colour, linestyle=style, linewidth=0.9, zorder=0)
    away = {"left": 3, "right": -3}[side]
    plot.annotate(label, (frequency, 0.985), (away, 0), xycoords=plot.get_xaxis_transform(), textcoords="offset points",
                  color=colour, fontsize=8, ha=side, va="top")  # fmt: skip


def _save(figure, file):
    figure.savefig(file, dpi=110, format="png")
