"""A tree of bodies drawn from its table: bodies as discs, hinges as numbered lines, the root on the left.

    ./trackvib exec -- python -m trackvib_sim.drawings.topology_picture PICTURE.png [ROOT [VEHICLE]]

draws a vehicle, by name or file, with the hull or another body as the transfer root.
"""

import sys

from matplotlib.figure import Figure

from ..data import find_vehicle
from ..rui.reference.placement import parent_rows
from ..rui.reference.reroot import reroot
from ..vehicle.body_tree import HULL, build_body_table, running_gear_kind
from ..vehicle.vehicle_file import read_vehicle

STYLES = {"revolute": "-", "prismatic": "--", "locked": ":", "elastic": "-."}
STEP = 2.2  # between generations, in the distance of two tips


def topology_picture(bodies, path):
    """Draw a table of bodies to a PNG file."""
    place = _layout(bodies)
    height = 1.0 + max(y for _, y in place)
    figure = Figure(figsize=(9.0, 0.32 * height + 1.0), layout="constrained")
    plot = figure.subplots()
    for row, parent in enumerate(parent_rows(bodies)):
        body, (x, y) = bodies[row], place[row]
        if parent >= 0:
            at = place[parent]
            plot.plot((at[0], x), (at[1], y), STYLES[body.hinge.kind], color="0.5", linewidth=1.0, zorder=1)
            near = 0.66  # of the way to the child, where lines have fanned out
            label = at[0] + near * (x - at[0]), at[1] + near * (y - at[1])
            plot.text(*label, str(body.hinge.number), fontsize=7, ha="center", va="center", color="#3b6ea5", zorder=3,
                      bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "edgecolor": "none"})  # fmt: skip
        plot.plot(x, y, "o", markersize=15, markerfacecolor="white", markeredgecolor="#d1662b", zorder=4)
        plot.text(x, y, str(body.number), fontsize=7.5, ha="center", va="center", zorder=5)
        name = running_gear_kind(body.name) or body.name.replace("_", " ")
        plot.text(x + 0.32, y, name, fontsize=7, va="center", zorder=5,
                  bbox={"boxstyle": "square,pad=0.05", "facecolor": "white", "edgecolor": "none"})  # fmt: skip
    for kind in sorted({body.hinge.kind for body in bodies if body.hinge}):
        plot.plot([], [], STYLES[kind], color="0.5", label=f"{kind} hinge")
    plot.legend(loc="lower left", fontsize=8, frameon=False)
    plot.margins(x=0.08)
    plot.axis("off")
    figure.savefig(path, dpi=110)


def _layout(bodies):
    """Tips evenly one below the other, every other body in the middle of its children."""
    parents = parent_rows(bodies)
    children = [[row for row, parent in enumerate(parents) if parent == each] for each in range(len(bodies))]
    place = [(0.0, 0.0)] * len(bodies)
    tips = iter(range(len(bodies)))

    def settle(row, generation):
        heights = [settle(child, generation + 1) for child in children[row]]
        y = sum(heights) / len(heights) if heights else -float(next(tips))
        place[row] = STEP * generation, y
        return y

    settle(0, 0)
    lowest = min(y for _, y in place)
    return [(x, y - lowest) for x, y in place]


def main():
    """Draw a vehicle."""
    picture, root, vehicle = (*sys.argv[1:], *(HULL, None)[len(sys.argv) - 2 :])
    topology_picture(reroot(build_body_table(read_vehicle(find_vehicle(vehicle))[0]), root), picture)


if __name__ == "__main__":
    main()
