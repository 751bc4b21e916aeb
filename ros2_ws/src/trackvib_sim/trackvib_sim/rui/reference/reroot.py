"""The same tree seen from another root: the hinges between the old root and the new one are passed the other way."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..state import Loads, TreeState, free_bodies
from ..table import check_table
from .placement import place_bodies


def reroot(bodies, name):
    """Return the table with body `name` as its root.

    A reversed hinge keeps its coordinate: parent and child change places and the axis changes its sign. The new child's
    origin moves to the hinge point, so its centre and the places of what hangs on it move against it.

    Raises
    ------
    ValueError
        No body has that name, or an elastic hinge, which has no one coordinate, stands between the two roots.
    """
    check_table(bodies)
    path, shifts = _path(bodies, name)
    new = {body.name: body for body in bodies}
    for body in bodies:
        if body.hinge is not None and body.hinge.parent in shifts and body.name not in shifts:
            place = np.asarray(body.hinge.place, dtype=float) - shifts[body.hinge.parent]
            new[body.name] = replace(body, hinge=replace(body.hinge, place=tuple(place)))
    reversed_hinge = None
    for body in path:
        centre = np.asarray(body.centre, dtype=float) - shifts[body.name]
        new[body.name] = replace(body, centre=tuple(centre), hinge=reversed_hinge)
        if body.hinge is not None:
            # on the old child, the hinge point is its own old origin
            axis = -np.asarray(body.hinge.axis, dtype=float)
            reversed_hinge = replace(body.hinge, parent=body.name, place=tuple(-shifts[body.name]), axis=tuple(axis))
    return _in_order(new, name)


def reroot_state(bodies, state, loads, name):
    """Return `TreeState` and `Loads` of `reroot(bodies, name)` from those of `bodies`, in the new table's order."""
    again = reroot(bodies, name)
    path, shifts = _path(bodies, name)
    placed = place_bodies(bodies, state)
    old = {body.name: row for row, body in enumerate(bodies)}
    # whose coordinate, torque and prescribed acceleration a body's hinge has now
    source = {body.name: old[body.name] for body in bodies}
    source.update({parent.name: old[child.name] for child, parent in zip(path, path[1:], strict=False)})
    source[name] = 0  # the root's rows are not used
    order = np.array([old[body.name] for body in again])
    hinge = np.array([source[body.name] for body in again])
    free = [order[row] for row in free_bodies(again)]
    moment = np.array(loads.moment)
    for each, shift in shifts.items():
        row = old[each]
        moment[row] -= np.cross(placed.rotation[row] @ shift, loads.force[row])
    turned = Rotation.from_matrix(placed.rotation[free]).as_quat()
    state = TreeState(
        placed.origin[free],
        np.roll(turned, 1, axis=1),  # scalar first
        placed.velocity[free],
        placed.angular_velocity[free],
        state.hinge[hinge],
        state.hinge_rate[hinge],
    )
    return state, Loads(loads.force[order], moment[order], loads.torque[hinge], loads.acceleration[hinge])


def _path(bodies, name):
    """Bodies from the new root to the old one, and by how far each of their origins moves in its own axes."""
    by_name = {body.name: body for body in bodies}
    if name not in by_name:
        raise ValueError(f"root {name!r} must be one of {', '.join(by_name)}")
    path, shifts = [by_name[name]], {name: np.zeros(3)}
    while path[-1].hinge is not None:
        hinge = path[-1].hinge
        if hinge.kind == "elastic":
            raise ValueError(f"root {name!r}: the elastic hinge {hinge.number} between it and the old root has no axis")
        path.append(by_name[hinge.parent])
        shifts[hinge.parent] = np.asarray(hinge.place, dtype=float)
    return path, shifts


def _in_order(bodies, root):
    """Parents before children, otherwise as they stood."""
    children = {}
    for body in bodies.values():
        if body.hinge is not None:
            children.setdefault(body.hinge.parent, []).append(body)
    ordered = [bodies[root]]
    for body in ordered:  # grows while it is gone through
        ordered += children.get(body.name, [])
    return ordered
