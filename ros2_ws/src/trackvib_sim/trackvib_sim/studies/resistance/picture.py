"""Running resistance over speed as a picture, the heat of each part of the vehicle on top of the other."""

import numpy as np
from matplotlib.figure import Figure

from ..case import GOOD
from .table import SINKS, force, published

KILO = 1e3


def resistance_picture(found, mass, title, file):
    """Draw a dict of cases and results of a vehicle of a mass [kg] to a PNG file."""
    good = {case.speed: result for case, result in found.items() if result.status == GOOD}
    speed = np.array(list(good))
    figure = Figure(figsize=(12.0, 5.6), layout="constrained")
    forces, powers = figure.subplots(1, 2)
    figure.suptitle(title)
    for plot, unit, of_speed in ((forces, "force, kN", speed), (powers, "power, kW", np.ones(len(speed)))):
        heat = np.array([[result.heat[name] for name in SINKS] for result in good.values()]).reshape(-1, len(SINKS))
        plot.stackplot(speed, heat.T / of_speed / KILO, labels=SINKS.values(), alpha=0.8)
        drive = np.array([force(result) for result in good.values()]) * (speed / of_speed) / KILO
        plot.plot(speed, drive, "k.-", label="at the sprockets")
        for style, name in zip(("--", ":"), published(mass, 1.0), strict=True):
            theirs = np.array([published(mass, v)[name] for v in speed]) * (speed / of_speed) / KILO
            plot.plot(speed, theirs, f"k{style}", label=f"formula {name} N per tonne")
        plot.set_xlabel("speed, m/s")
        plot.set_ylabel(unit)
        plot.set_ylim(bottom=0.0)
        plot.grid(alpha=0.3)
    figure.legend(*forces.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
    figure.savefig(file, dpi=110, format="png")
