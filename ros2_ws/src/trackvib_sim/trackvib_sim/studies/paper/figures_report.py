"""The text beside the figures: what each shows, and the numbers of both solvers."""

from itertools import product

import numpy as np

from ...analysis.numbers import SENSORS
from ...analysis.vibration import psd
from ..case import BAND, GOOD, MEASURING
from .paper_figures import AXES, VERTICAL

NEAR = 0.1  # of the frequency of link passing
LINES_FROM = 20.0  # Hz; below it vibrate the vehicle on its suspension and the powertrain on its mounts
SENTENCES = {
    "road.png": "The road under both tracks over time, and its spectrum with line and bounds of its class.",
    "histories.png": "Chassis is the hull at the powertrain's rear connection, powertrain its input end, midway "
    "between the mounts.",
    "spectra.png": "Dashed: passing track links, at speed over pitch and its multiples; dotted: engine orders.",
    "levels.png": f"Runs of {MEASURING:g} s after settling, one for each point.",
    "solvers.png": "Both runs have the same start, road and force laws; only the solver of the body tree differs.",
}


def case_in_words(case):
    """Return road class and speed of a `drive.Case`."""
    return f"class {case.road_class} at {case.speed:g} m/s"


def report(titles, found, case, comparison, link_passing):
    """Return the text of `figures.md`.

    Parameters
    ----------
    titles : dict
        Name of each picture -> its title.
    found : dict
        `drive.Case` -> `drive.Result` of the levels.
    case : drive.Case
        Of the comparison.
    comparison : second_solver.Comparison
    link_passing : float
        Speed over pitch of that case, Hz.
    """
    lines = ["# Figures compared with [Tao2025]", ""]
    for name, title in titles.items():
        lines += [f"![{title}]({name})", "", SENTENCES[name], ""]
    for other, result in found.items():
        if result.status != GOOD:
            lines += [f"No values for {case_in_words(other)}: {result.status}.", ""]
    lines += ["## The two solvers", "", *_levels(case, comparison), "", *_highest_lines(comparison, link_passing)]
    return "\n".join(lines) + "\n"


def _levels(case, comparison):
    (first, ours), (second, theirs) = comparison.levels().items()
    yield (
        f"RMS acceleration in m/s², {case_in_words(case)}, {BAND[0]:g}-{BAND[1]:g} Hz. At every time step both solvers "
        "received the same state and the same forces. The greatest difference of their accelerations, relative to the "
        f"largest one, was **{comparison.difference:.1e}**. The runs, each with its own solver, nevertheless diverge, "
        "because contacts amplify rounding; compare their statistics."
    )
    yield ""
    yield f"| sensor | axis | {first} | {second} | difference |"
    yield "|---|---|---|---|---|"
    for sensor, (axis, name) in product(SENSORS, enumerate(AXES)):
        one, other = ours[sensor][axis], theirs[sensor][axis]
        yield f"| {sensor} | {name} | {one:.3f} | {other:.3f} | {other / one - 1.0:+.2%} |"


def _highest_lines(comparison, link_passing):
    yield (
        f"Highest lines of the vertical spectra, in bins of 1 Hz. Links pass at {link_passing:.2f} Hz; [Tao2025] has "
        "86.93 Hz by the Rui method and 88.31 Hz by ADAMS."
    )
    yield ""
    yield f"| sensor | solver | within {NEAR:.0%} of link passing | above {LINES_FROM:g} Hz |"
    yield "|---|---|---|---|"
    for sensor, (solver, drive) in product(SENSORS, comparison.drives.items()):
        frequency, density = psd(drive.specific_force[sensor][:, VERTICAL], drive.rate)
        parts = np.abs(frequency - link_passing) < NEAR * link_passing, frequency > LINES_FROM
        near, above = (frequency[part][density[part].argmax()] for part in parts)
        yield f"| {sensor} | {solver} | {near:.0f} Hz | {above:.0f} Hz |"
