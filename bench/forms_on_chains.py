"""Accuracy of the forms of the method on chains: why products of transfer matrices alone are not the production form.

    ./trackvib exec -- python bench/forms_on_chains.py

"Look-ahead" is the elimination that keeps everything at 13 x 13: each hinge's acceleration follows from the known
torque of the *next* hinge. All are compared with Pinocchio's articulated-body algorithm, relative to the largest hinge
acceleration. The last lines show the look-ahead's pivot where consecutive axes are perpendicular.
"""

import numpy as np
from machine import machine
from peers import PinocchioTree
from rich.console import Console
from rich.table import Table
from trackvib_sim.rui.reference.form_a import form_a, overall_transfer
from trackvib_sim.rui.reference.form_x import form_x
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

GRAVITY = (0.0, 0.0, -9.81)
INERTIA = np.diag([0.01, 0.03, 0.03])
LINKS = (5, 10, 15, 20, 25, 30, 60, 100)


def chain(links, axes):
    """Return table, state and loads of a chain of equal links, bent and in motion."""
    bodies = [Body(0, "0", 2.0, (0.1, 0.0, 0.0), INERTIA)]
    for row in range(1, links):
        hinge = Hinge(1000 + row, "revolute", str(row - 1), (0.2, 0.0, 0.0), axes[row % len(axes)])
        bodies.append(Body(row, str(row), 2.0, (0.1, 0.0, 0.0), INERTIA, hinge))
    random = np.random.default_rng(links)
    state, loads = rest_state(bodies), no_loads(bodies)
    state.hinge[1:], state.hinge_rate[1:] = 0.3 * random.normal(size=(2, links - 1))
    loads.torque[1:] = random.normal(size=links - 1)
    return bodies, state, loads


def look_ahead(bodies, state, loads):
    """Return hinge accelerations (n,) by products of 13 x 13 matrices.

    thdd_h = -n (U_H z_I) / (n b_h) with n = E_{h+} U_b, the row that gives the next hinge's torque behind the next
    body; at the root, whose output is free, the torque about the last axis is zero.
    """
    transfer = overall_transfer(bodies, state, loads, GRAVITY)
    n = len(bodies)
    to_here = transfer.body[n - 1][0]  # from the tip's free end to the present place
    rows, steps = [transfer.hinge[n - 1].E @ to_here], []
    for row in range(n - 1, 0, -1):
        hinge, ahead = transfer.hinge[row], row_ahead(transfer, row)
        steps.append(-(ahead @ hinge.U @ to_here) / (ahead @ hinge.b))
        to_here = transfer.body[row - 1][0] @ (hinge.U @ to_here + np.outer(hinge.b, steps[-1]))
    # the torque about the last axis has been used up as the last pivot
    across = np.linalg.svd(transfer.placement.axis[1][None])[2][1:]
    rows = np.vstack((*rows, across @ to_here[6:9], to_here[9:12]))
    scale = np.abs(rows).max(axis=1, keepdims=True)
    tip = np.zeros(13)  # no force and no moment at the free end
    tip[:6] = np.linalg.solve((rows / scale)[:, :6], -(rows / scale)[:, 12])
    tip[12] = 1.0
    return np.array([0.0, *(step @ tip for step in reversed(steps))])


def row_ahead(transfer, row):
    """Return n (13,) of hinge `row`: the torque about the next axis, seen from the input of the body before it."""
    parent = row - 1
    known = transfer.hinge[parent].E if parent else np.array([*np.zeros(6), *transfer.placement.axis[1], *np.zeros(4)])
    return known @ transfer.body[parent][0]


def smallest_pivot(axes):
    """Return the smallest pivot n b_h of a straight chain of four links against the inertia of one link."""
    bodies, state, loads = chain(4, axes)
    state.hinge[:] = 0.0
    transfer = overall_transfer(bodies, state, loads, GRAVITY)
    return min(abs(row_ahead(transfer, row) @ transfer.hinge[row].b) for row in (1, 2, 3)) / INERTIA[1, 1]


def main():
    """Compare and print."""
    out = Console()
    table = Table(title=f"largest error of a hinge acceleration, chains with parallel axes; {machine()}")
    for column in ("links", "look-ahead", "form A", "form X", "Riccati"):
        table.add_column(column, justify="right")
    for links in LINKS:
        bodies, state, loads = chain(links, ((0, 1, 0),))
        wanted = PinocchioTree(bodies, GRAVITY).accelerations(state, loads.torque)[6:]
        found = [look_ahead(bodies, state, loads)]
        found += [form(bodies, state, loads, GRAVITY).hinge for form in (form_a, form_x, accelerations)]
        errors = [np.abs(each[1:] - wanted).max() / np.abs(wanted).max() for each in found]
        table.add_row(str(links), *(f"{error:.0e}" for error in errors))
    out.print(table)
    for name, axes in (("parallel", ((0, 1, 0),)), ("perpendicular", ((0, 1, 0), (0, 0, 1)))):
        out.print(f"smallest look-ahead pivot / inertia of a link, straight, {name} axes: {smallest_pivot(axes):.0e}")


if __name__ == "__main__":
    main()
