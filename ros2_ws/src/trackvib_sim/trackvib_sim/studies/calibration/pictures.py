"""Pictures of a calibration: how the search went, and how sensitive the table is."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..paper.paper_table import SENSORS, error_factor
from ..paper.table1_picture import AXES
from .objective import typical_excess
from .sensitivity import PER

_WIDE = 6  # panels side by side


def convergence_picture(file, plan, candidates):
    """Draw objective and parameters of `calibration_history.Candidate`s in their order to a PNG file."""
    count = len(plan.parameters)
    deep = -(-count // _WIDE)
    figure = Figure(figsize=(14, 3.2 + 1.8 * deep), layout="constrained")
    grid = figure.add_gridspec(deep + 1, _WIDE, height_ratios=[1.8, *[1.0] * deep])
    objective = np.array([candidate.objective for candidate in candidates])
    number = np.arange(1, len(candidates) + 1)
    best = objective.argmin()
    # grey levels by rank: the good ones stand out whatever the scale of the objective is
    rank = objective.argsort().argsort() / len(objective)
    top = figure.add_subplot(grid[0, :])
    top.plot(number, objective, ".", color="0.6", markersize=4, label="candidate")
    top.plot(number, np.minimum.accumulate(objective), color="#d1662b", drawstyle="steps-post", label="best so far")
    top.set_yscale("log")
    for formatter in (top.yaxis.set_major_formatter, top.yaxis.set_minor_formatter):
        formatter("{x:g}")
    top.xaxis.set_major_locator(MaxNLocator(5, integer=True))  # of all panels: they share the axis
    top.set_ylabel("objective")
    top.set_xlabel("candidate, in the order of evaluation")
    top.legend()
    top.grid(alpha=0.3, which="both")
    for k, parameter in enumerate(plan.parameters):
        panel = figure.add_subplot(grid[1 + k // _WIDE, k % _WIDE], sharex=top)
        values = np.array([candidate.values[k] for candidate in candidates])
        order = objective.argsort()[::-1]
        panel.scatter(number[order], values[order], c=rank[order], cmap="viridis", s=8, linewidths=0)
        panel.plot(number[best], values[best], "o", color="none", markeredgecolor="#d1662b", markersize=8)
        panel.set_yscale(parameter.scale)
        panel.set_ylim(parameter.low, parameter.high)
        panel.set_title(parameter.item, fontsize=8)
        panel.tick_params(which="both", labelsize=7)
    figure.suptitle("Calibration: dark is good, the ring is the best; panels reach from bound to bound", fontsize=12)
    figure.savefig(file, dpi=110, format="png")


def frontier_picture(file, history):
    """Draw what the table costs in running resistance: all candidates whose runs were good, to a PNG file."""
    good = [
        each for each in history.candidates if np.isfinite(each.ratios).all() and np.isfinite(each.resistance).all()
    ]
    factor = np.array([error_factor(each.ratios, 1.0) for each in good])
    excess = np.array([typical_excess(each.resistance) for each in good])
    figure = Figure(figsize=(8.0, 5.6), layout="constrained")
    plot = figure.subplots()
    plot.plot(excess, factor, ".", color="0.65", label="candidate")
    order = np.lexsort((factor, excess))
    best = np.minimum.accumulate(factor[order])
    plot.plot(excess[order], best, color="#d1662b", drawstyle="steps-post", label="frontier")
    for each, sign, label in ((history.best, "s", "least objective"), (history.chosen, "o", "chosen")):
        place = typical_excess(each.resistance), error_factor(each.ratios, 1.0)
        plot.plot(*place, sign, color="none", markeredgecolor="k", markersize=10, label=label)
    plot.axvline(1.0, color="k", linestyle="--", linewidth=0.9, label="highest published formula")
    plot.set_xlabel("running resistance over the highest published formula, geometric mean over the speeds")
    plot.set_ylabel("error factor of the table")
    plot.set_title("What the table costs in running resistance", fontsize=12)
    plot.grid(alpha=0.3)
    plot.legend()
    figure.savefig(file, dpi=110, format="png")


def sensitivity_picture(file, plan, rows, sensitive):
    """Draw a `sensitivity.Sensitivity` as a heat map to a PNG file: parameters by strength, the table by columns."""
    order, count = sensitive.order, len(rows)
    change = 100.0 * sensitive.change[order]
    limit = np.nanpercentile(np.abs(change), 99)
    size = 4.0 + 1.44 * count, max(4.0, 2.4 + 0.26 * len(order))
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(1, 6, sharey=True)
    for column, panel in enumerate(panels):
        image = panel.imshow(change[:, :, column], cmap="RdBu_r", vmin=-limit, vmax=limit, aspect="auto")
        panel.set_facecolor("0.6")  # where a run failed
        panel.set_title(f"{SENSORS[column // 3]}\n{AXES[column % 3]}", fontsize=9)
        names = [f"{road_class} {speed:g}" for road_class, speed in rows]
        panel.set_xticks(range(count), names, rotation=90, fontsize=7)
    panels[0].set_yticks(range(len(order)), [plan.items[k] for k in order], fontsize=8)
    figure.supxlabel("road class and speed in m/s", fontsize=9)
    bar = figure.colorbar(image, ax=panels.tolist(), pad=0.01, aspect=30)
    bar.set_label(f"change of RMS for +{100.0 * PER:.0f} % of the range, %", fontsize=9)
    noise = f"; noise {100.0 * sensitive.noise:.1f} %" if np.isfinite(sensitive.noise) else ""
    title = "Sensitivity at the calibrated set, the strongest parameter first; grey: a run failed"
    figure.suptitle(title + noise, fontsize=12)
    figure.savefig(file, dpi=110, format="png")
