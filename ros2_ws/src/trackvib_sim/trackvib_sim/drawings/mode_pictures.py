"""Modes drawn as wire frames: every body as the box of even density that has its mass and inertia."""

from itertools import combinations, product

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from ..rui.reference.placement import place_bodies

VIEWS = {"from the side": (0, 2), "from the rear": (1, 2)}  # which of x, y, z lie along the picture's axes
COLUMNS = 3
LARGEST = 0.35  # m, to which the largest displacement is drawn
CORNERS = np.array(list(product((-0.5, 0.5), repeat=3)))
EDGES = [pair for pair in combinations(range(8), 2) if np.abs(CORNERS[pair[0]] - CORNERS[pair[1]]).sum() == 1.0]


def mode_pictures(model, modes, titles, path):
    """Draw each mode from the side and from the rear, at rest in grey and at one extreme in colour, to a PNG file.

    Parameters
    ----------
    model : rui.linear_model.LinearModel
        In axes x forward, z up.
    modes : sequence of rui.modes.Mode
    titles : sequence of str
    path : path-like
    """
    rows = -(-len(modes) // COLUMNS)
    figure = Figure(figsize=(4.8 * COLUMNS, 2.3 * rows), layout="constrained")
    cells = figure.subfigures(rows, COLUMNS, squeeze=False).ravel()
    origin, arms = _boxes(model)
    at_rest = origin + arms
    for cell, mode, title in zip(cells, modes, titles, strict=False):
        cell.suptitle(title, fontsize=8)
        moved = at_rest + _displacement(mode, arms)
        plots = cell.subplots(1, 2, width_ratios=(2.2, 1.0))
        for plot, (view, (across, up)) in zip(plots, VIEWS.items(), strict=True):
            for corners, colour in ((at_rest, "0.8"), (moved, "#d1662b")):
                lines = corners[:, EDGES][..., (across, up)].reshape(-1, 2, 2)
                plot.add_collection(LineCollection(lines, colors=colour, linewidths=0.7))
            plot.set_aspect("equal")
            plot.set_title(view, fontsize=6, color="0.5", y=-0.12)
            plot.autoscale()
            plot.axis("off")
    figure.savefig(path, dpi=110)


def _boxes(model):
    """Return origins (n, 1, 3) of the bodies and the corners (n, 8, 3) of their boxes from there, global axes."""
    placed = place_bodies(model.bodies, model.state)
    arms = np.empty((len(model.bodies), 8, 3))
    for row, body in enumerate(model.bodies):
        principal, axes = np.linalg.eigh(np.asarray(body.inertia, dtype=float))
        # I_x = m (l_y^2 + l_z^2) / 12, solved for the sides
        sides = np.sqrt(np.maximum(6.0 * (principal.sum() - 2.0 * principal) / body.mass, 0.0))
        corners = np.asarray(body.centre, dtype=float) + (CORNERS * sides) @ axes.T
        arms[row] = corners @ placed.rotation[row].T
    return placed.origin[:, None], arms


def _displacement(mode, arms):
    x = mode.x.real[:, None]
    moved = x[..., :3] + np.cross(x[..., 3:], arms)
    size = np.abs(moved).max()
    # a mode has no sign of its own: the first body that moves much does so forward, to the left or up
    sign = np.sign(moved[np.abs(moved) > 0.5 * size][0])
    return sign * LARGEST / np.linalg.norm(moved, axis=-1).max() * moved
