"""What each mount carries where its ends meet: the file's static load, or its share of the weight.

Mounts are trimmed for the load that they carry in the vehicle at rest, so that they stand where the drawing has them.
A body on several mounts is statically indeterminate: its weight is shared as by untrimmed mounts of the same stiffness,
that of MR mounts in the middle of their currents.
"""

import numpy as np

from ..rui.reference.placement import place_bodies
from ..rui.state import rest_state
from .body_tree import GRAVITY, bodies_on_hinges, build_body_table
from .mounts import KN_PER_MM, mount_turn

_DECIMALS = 6  # of a load in N


def loads_at_rest(vehicle):
    """Return the load (3,) [N] on its body of each mount by name, in the mount's axes."""
    loads = {name: np.array([0.0, 0.0, mount.static_load or 0.0]) for name, mount in vehicle.mounts.items()}
    for body in {mount.body: None for mount in vehicle.mounts.values()}:
        loads |= _shares(vehicle, body, loads)
    return loads


def _shares(vehicle, body, loads):
    """The loads of those mounts of a body that the file does not give."""
    ways = _ways(bodies_on_hinges(vehicle)[body])
    held = {name: mount for name, mount in vehicle.mounts.items() if mount.body == body}
    given = [name for name, mount in held.items() if mount.static_load is not None or mount.unloaded_height is not None]
    open_ones = [name for name in held if name not in given]
    if not open_ones or not len(ways):
        return {}
    mass, centre = _carried(vehicle, body)
    work = _motions(ways, centre)[:, 2] * -mass * GRAVITY  # of the weight, a unit way each
    for name in given:
        turn = mount_turn(held[name])
        force = turn @ (loads[name] + _stiffness(vehicle, held[name]) @ (0.0, 0.0, held[name].unloaded_height or 0.0))
        work += _motions(ways, held[name].place) @ force
    motions = {name: _motions(ways, held[name].place) @ mount_turn(held[name]) for name in open_ones}
    stiffness = {name: _stiffness(vehicle, held[name]) for name in open_ones}
    total = sum(motions[name] @ stiffness[name] @ motions[name].T for name in open_ones)
    sink = np.linalg.lstsq(total, work, rcond=1e-12)[0]
    # linear algebra chooses its way by processor, and the last bits with it
    return {name: np.round(-stiffness[name] @ motions[name].T @ sink, _DECIMALS) for name in open_ones}


def _ways(section):
    """How a body can move against its parent: displacement and rotation (n, 6) of its origin by coordinate."""
    if section.hinge in ("free", "elastic"):
        return np.eye(6)
    if section.hinge == "fixed":
        return np.zeros((0, 6))
    axis = np.array(section.axis) / np.linalg.norm(section.axis)
    return np.array([(*np.zeros(3), *axis) if section.hinge == "revolute" else (*axis, *np.zeros(3))])


def _motions(ways, point):
    """Displacement (n, 3) of a point of the body under its ways to move."""
    return ways[:, :3] + np.cross(ways[:, 3:], point)


def _stiffness(vehicle, mount):
    """Stiffness (3, 3) along the mount's own axes [N/m]."""
    kind = vehicle.mount_types[mount.type]
    if kind.kind == "rubber":
        return np.diag(kind.stiffness)
    k = KN_PER_MM * np.polyval(kind.stiffness_fit, np.mean(kind.current_range))
    return k * np.diag((*kind.stiffness_ratio, 1.0))


def _carried(vehicle, body):
    """Mass [kg] of a body with all that stands on it, and its centre (3,) [m] from the body's origin."""
    table = build_body_table(vehicle)
    placed, on_it, masses, centres = place_bodies(table, rest_state(table)), {body}, [], []
    for each, origin in zip(table, placed.origin, strict=True):
        if each.name == body:
            here = origin
        if each.name in on_it or (each.hinge is not None and each.hinge.parent in on_it):
            on_it.add(each.name)
            masses.append(each.mass)
            centres.append(origin + each.centre)
    return sum(masses), np.average(centres, axis=0, weights=masses) - here
