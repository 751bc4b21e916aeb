"""Description of a tree at rest with its springs and dampers, about which small motions are studied.

Every force law here is affine in the displacement and speed of one point, so that the same description serves to find
the equilibrium (`equilibrium`) and to linearise about it (`linear_tree`).
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ..reference.placement import place_bodies
from ..state import Loads, TreeState, no_loads
from ..table import check_table


def _zeros(*shape):
    return field(default_factory=lambda: np.zeros(shape))


@dataclass(frozen=True)
class GroundSpring:
    """A spring and damper between a point of a body and the ground; without stiffness a force on that point.

    Force on the body, global axes: `force` - stiffness (r - place) - damping r_d with r the place of the point.

    Attributes
    ----------
    body : str
    point : (3,) array
        In the body's axes from its origin [m].
    stiffness, damping : (3, 3) or (6, 6) arrays
        Global axes [N/m, N s/m]; as (6, 6) matrices also against rotation (displacement first, then rotation).
    force : (3,) or (6,) array
        On the body where the point is at `place` [N; N m].
    place : (3,) array or None
        Global [m]; None is where the point is in the model's state.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rui.GroundSpring("base", stiffness=1e4 * np.eye(3), damping=1e2 * np.eye(3)).point
    array([0., 0., 0.])
    """

    body: str
    point: np.ndarray = _zeros(3)
    stiffness: np.ndarray = _zeros(3, 3)
    damping: np.ndarray = _zeros(3, 3)
    force: np.ndarray = _zeros(3)
    place: np.ndarray | None = None

    def force_at(self, place):
        """Return the static wrench (6,) on the body at the point, which is at `place` (3,) [m], global axes."""
        wrench = np.zeros(6)
        wrench[: len(self.force)] = self.force
        if self.place is not None:
            shift = np.subtract(place, self.place)
            wrench[: len(self.stiffness)] -= np.asarray(self.stiffness)[:, :3] @ shift
        return wrench


@dataclass(frozen=True)
class Mount:
    """A spring and damper between a body and its parent, beside the hinge between the two.

    Force on the body, in the parent's axes: `force` - stiffness (l - place) - damping l_d, with l the place of the
    body's point as seen from the parent. The reaction acts on the parent at the same point in space, so that no
    couple is left over (derived in docs/method.md).

    Attributes
    ----------
    body : str
        The child.
    point : (3,) array
        In the child's axes from its origin [m].
    stiffness, damping : (3, 3) arrays
        Parent's axes [N/m, N s/m].
    force : (3,) array
        On the child where the point is at `place`, parent's axes [N].
    place : (3,) array or None
        In the parent's axes from its origin [m]; None is where the point is in the model's state.
    """

    body: str
    point: np.ndarray = _zeros(3)
    stiffness: np.ndarray = _zeros(3, 3)
    damping: np.ndarray = _zeros(3, 3)
    force: np.ndarray = _zeros(3)
    place: np.ndarray | None = None

    def force_at(self, place):
        """Return the static force (3,) [N] on the child, parent's axes, its point being at `place` (3,) [m] there."""
        if self.place is None:
            return np.asarray(self.force, dtype=float)
        return self.force - np.asarray(self.stiffness) @ np.subtract(place, self.place)


@dataclass(frozen=True)
class LinearModel:
    """A tree in a state of rest, with the laws of its springs and dampers.

    Attributes
    ----------
    bodies : sequence of Body
        The table, n bodies.
    state : TreeState
        All speeds zero.
    gravity : (3,) array
        Global axes [m/s^2].
    stiffness, damping : (n,) arrays or None
        Of the hinges, in the row of the child [N m/rad, N m s/rad; N/m, N s/m if prismatic]; None is zero. Torque on
        the child along the axis: `loads.torque` - stiffness (th - free) - damping thd. Elastic hinges have theirs in
        the table.
    free : (n,) array or None
        Coordinates where the torque is `loads.torque` [rad or m]; None is the model's state.
    springs, mounts : sequences of GroundSpring and Mount
    loads : Loads or None
        Further constant loads. A force of `loads` acts at the origin of its body; a constant force on another point
        is a GroundSpring without stiffness. Accelerations of prescribed hinges must be zero.
    fixed_root : bool
        The root is held; otherwise it is free.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> model = rui.LinearModel(bodies, rui.rest_state(bodies), fixed_root=True)
    >>> model.stiffness  # none given
    array([0., 0.])
    """

    bodies: tuple
    state: TreeState
    gravity: tuple = (0.0, 0.0, -9.81)
    stiffness: np.ndarray | None = None
    damping: np.ndarray | None = None
    free: np.ndarray | None = None
    springs: tuple = ()
    mounts: tuple = ()
    loads: Loads | None = None
    fixed_root: bool = False

    def __post_init__(self):
        """Fill in what was left out and refuse what does not fit."""
        check_table(self.bodies)
        n = len(self.bodies)
        defaults = {"stiffness": np.zeros(n), "damping": np.zeros(n), "free": self.state.hinge}
        for name, default in defaults.items():
            given = getattr(self, name)
            values = np.array(default if given is None else given, dtype=float)
            if values.shape != (n,):
                raise ValueError(f"{name} has shape {values.shape}, must have one value for each of the {n} bodies")
            object.__setattr__(self, name, values)
        if self.loads is None:
            object.__setattr__(self, "loads", no_loads(self.bodies))
        _check_places(self)


def anchored(model):
    """Return `model` with places for all springs and mounts: where None, where their points are in its state."""
    here = _points(model)
    springs, mounts = (
        tuple(item if item.place is not None else replace(item, place=place) for item, place in zip(*pair, strict=True))
        for pair in zip((model.springs, model.mounts), here, strict=True)
    )
    return replace(model, springs=springs, mounts=mounts)


def settled(model):
    """Return `model` with every law referred to its own state: forces as they are there, no free coordinate left."""
    at_springs, at_mounts = _points(model)
    springs = [
        replace(spring, force=spring.force_at(place)[: len(spring.stiffness)], place=None)
        for spring, place in zip(model.springs, at_springs, strict=True)
    ]
    mounts = [
        replace(mount, force=mount.force_at(place), place=None)
        for mount, place in zip(model.mounts, at_mounts, strict=True)
    ]
    torque = model.loads.torque - model.stiffness * (model.state.hinge - model.free)
    return replace(
        model,
        springs=tuple(springs),
        mounts=tuple(mounts),
        loads=model.loads._replace(torque=torque),
        free=model.state.hinge,
    )


def _points(model):
    """Return the places of the springs' points, global, and of the mounts', as the parents see them [m]."""
    where = place_bodies(model.bodies, model.state)
    rows = {body.name: row for row, body in enumerate(model.bodies)}

    def point(item):
        return where.origin[rows[item.body]] + where.rotation[rows[item.body]] @ item.point

    def seen(mount):
        parent = rows[model.bodies[rows[mount.body]].hinge.parent]
        return where.rotation[parent].T @ (point(mount) - where.origin[parent])

    return [point(spring) for spring in model.springs], [seen(mount) for mount in model.mounts]


def _check_places(model):
    hinges = {body.name: body.hinge for body in model.bodies}
    for spring in model.springs:
        if spring.body not in hinges:
            raise ValueError(f"spring on {spring.body!r}: no such body; known are {', '.join(hinges)}")
        size = np.shape(spring.stiffness)
        if size not in ((3, 3), (6, 6)) or np.shape(spring.damping) != size or np.shape(spring.force) > size[:1]:
            raise ValueError(f"spring on {spring.body!r}: stiffness and damping must both be 3 x 3 or both 6 x 6")
    for mount in model.mounts:
        if hinges.get(mount.body) is None:
            raise ValueError(f"mount of {mount.body!r}: no body with a parent of that name")
        if np.shape(mount.stiffness) != (3, 3) or np.shape(mount.damping) != (3, 3):
            raise ValueError(f"mount of {mount.body!r}: stiffness and damping must be 3 x 3")
    for row, body in enumerate(model.bodies):
        moves = body.hinge is not None and body.hinge.kind in ("revolute", "prismatic")
        if not moves and (model.stiffness[row] or model.damping[row]):
            raise ValueError(f"body {body.name!r}: stiffness and damping are for revolute and prismatic hinges only")
    for name in ("velocity", "angular_velocity", "hinge_rate"):
        if np.any(getattr(model.state, name)):
            speeds = getattr(model.state, name).tolist()
            raise ValueError(f"the state's {name} is {speeds}, must be zero: a state of rest")
