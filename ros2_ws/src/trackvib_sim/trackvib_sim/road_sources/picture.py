"""A road as a picture: its profile, and its PSD beside the classes of ISO 8608."""

import numpy as np
from matplotlib.figure import Figure
from mr_mount_controller.node_base.plain_text import plain_line

from ..road.classes import CLASSES
from ..road.iso8608 import roughness_of
from .measures import FITTED, psd, smoothed

COLOURS = {"left": "#1f5fa8", "right": "#d1662b"}
_FREQUENCIES, _DENSITIES = (0.005, 10.0), (1e-10, 1e2)  # 1/m, m^3; of the axes
_MOST_DRAWN = 20_000  # samples of a profile


def road_picture(distance, heights, title, file):
    """Draw heights (2, n) [m] over distance (n,) [m] to a PNG file."""
    spacing = distance[1] - distance[0]
    figure = Figure(figsize=(13.0, 5.0), layout="constrained")
    profile, spectrum = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    figure.suptitle(plain_line(title), fontsize=12, parse_math=False)  # a file's name comes from outside
    step = max(1, len(distance) // _MOST_DRAWN)
    frequency = np.geomspace(*FITTED, 50)
    for each in CLASSES:
        spectrum.loglog(frequency, roughness_of(each).psd(frequency), color="0.7", linewidth=0.8)
        spectrum.annotate(each, (frequency[-1], roughness_of(each).psd(frequency[-1])), color="0.4", va="center",
                          xytext=(3, 0), textcoords="offset points", fontsize=8)  # fmt: skip
    for values, (side, colour) in zip(heights, COLOURS.items(), strict=True):
        profile.plot(distance[::step], 1e3 * values[::step], color=colour, linewidth=0.8, label=side)
        if np.ptp(values) > 0.0:
            spectrum.loglog(*psd(values, spacing), color=colour, linewidth=0.5, alpha=0.4)
            spectrum.loglog(*smoothed(values, spacing), "o-", color=colour, markersize=3, label=side)
    profile.set(xlabel="distance, m", ylabel="height, mm")
    spectrum.set(xlabel="spatial frequency, 1/m", ylabel="displacement PSD, m³", xlim=_FREQUENCIES, ylim=_DENSITIES)
    spectrum.set_title("third octaves; grey: means of the classes of ISO 8608", fontsize=9)
    for plot in (profile, spectrum):
        plot.grid(alpha=0.3)
    if profile.get_legend_handles_labels()[0]:
        profile.legend()
    figure.savefig(file, dpi=110, format="png")
