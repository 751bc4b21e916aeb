"""Mounts between a body and its parent: magnetorheological ones, whose current is set, and rubber ones.

A mount has three axes of its own; its force along them is that of `mount_law`. Force and reaction act at the same point
(the upper end), so that the pair carries no couple; the paper moves the reaction to the lower end instead, which would.

MR mounts come first, in the order of the file, then the rubber ones: coil i is that of mount i.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..numerics.compiled import inlined, kernel
from ..numerics.spatial import load3, rotate, rotate_back, scale, store3, subtract
from ..rui.sweeps.articulated import apply_force
from ..rui.sweeps.kinematics import body_axes, point_place, point_velocity, rotation
from .body_tree import bodies_on_hinges
from .mount_law import mount_axes, mount_force
from .parameters import POWERTRAIN

KILO = 1e3
KN_PER_MM = 1e6  # N/m
NO_YIELD = (0.0, 0.0, 0.0, np.inf)
_FINE = 1001  # currents at which the least stiffness is looked for


class Mounts(NamedTuple):
    """All mounts, m of them, the first c with coils."""

    coils: int  # c
    parent: np.ndarray  # (m,) rows in the tree
    body: np.ndarray  # (m,)
    upper: np.ndarray  # (m, 3) upper ends in the body, m
    lower: np.ndarray  # (m, 3) lower ends in the parent, m
    axes: np.ndarray  # (m, 9) turns the mount's axes into those of the parent
    load: np.ndarray  # (m, 3) on the body where the ends meet, mount's axes, N
    excited: np.ndarray  # (m,) 1 for a mount of the powertrain, else 0
    unloaded: np.ndarray  # (m,) height over there at which the springs are at ease, m
    stiffness_fit: np.ndarray  # (c, 4) N/m, highest power of I first
    damping_ratio_fit: np.ndarray  # (c, 4)
    carried_mass: np.ndarray  # (c,) kg
    rubber: np.ndarray  # (m,) least k(I), N/m; of rubber mounts 1, for their stiffness is no ratio
    rubber_damping_ratio: np.ndarray  # (c,) without a field
    highest: np.ndarray  # (c,) end of the fits, A
    yield_fit: np.ndarray  # (c, 4) N, as the other fits; infinite where the fluid does not yield
    stiffness: np.ndarray  # (m, 3) by axis: ratios to k(I), of rubber N/m
    damping: np.ndarray  # (m, 3) likewise: ratios to c(I), of rubber N s/m


class MountSample(NamedTuple):
    """State of all mounts at one instant, vectors in their parents' axes; k and c are those of the field."""

    current: np.ndarray  # (c,) in the coil, A
    stiffness: np.ndarray  # (m,) along z, N/m
    damping: np.ndarray  # (m,) along z, N s/m
    deflection: np.ndarray  # (m, 3) m
    velocity: np.ndarray  # (m, 3) m/s
    force: np.ndarray  # (m, 3) on the body, N
    dissipated_power: np.ndarray  # (m,) W


def new_mount_sample(mounts):
    """Return room for the state of all mounts."""
    c, m = mounts.coils, len(mounts.body)
    shapes = (c, m, m, (m, 3), (m, 3), (m, 3), m)
    return MountSample(*(np.zeros(shape) for shape in shapes))


def mounts_in_order(vehicle):
    """Return names and sections of the mounts, those with coils first."""
    return sorted(vehicle.mounts.items(), key=lambda each: vehicle.mount_types[each[1].type].kind != "mr")


def build_mounts(vehicle, rows, loads):
    """Return the record for the vehicle; `loads` is `mount_loads.loads_at_rest`."""
    listed = mounts_in_order(vehicle)
    bodies, names = bodies_on_hinges(vehicle), [name for name, _ in listed]
    mounts = [mount for _, mount in listed]
    types = [vehicle.mount_types[mount.type] for mount in mounts]
    mr = [kind for kind in types if kind.kind == "mr"]
    places = [(mount.place, bodies[mount.body].place) for mount in mounts]
    return Mounts(
        coils=len(mr),
        parent=np.array([rows[bodies[mount.body].parent] for mount in mounts], dtype=np.int64),
        body=np.array([rows[mount.body] for mount in mounts], dtype=np.int64),
        upper=_rows([upper for upper, _ in places], 3),
        lower=_rows([np.add(upper, origin) for upper, origin in places], 3),
        axes=_rows([mount_turn(mount).ravel() for mount in mounts], 9),
        load=_rows([loads[name] for name in names], 3),
        excited=np.array([float(mount.body == POWERTRAIN) for mount in mounts], dtype=float),
        unloaded=np.array([mount.unloaded_height or 0.0 for mount in mounts], dtype=float),
        stiffness_fit=KN_PER_MM * _rows([kind.stiffness_fit for kind in mr], 4),
        damping_ratio_fit=_rows([kind.damping_ratio_fit for kind in mr], 4),
        carried_mass=np.array([kind.carried_mass for kind in mr], dtype=float),
        rubber=np.array([_least_stiffness(kind) for kind in types], dtype=float),
        rubber_damping_ratio=np.array([kind.rubber_damping_ratio for kind in mr], dtype=float),
        highest=np.array([kind.current_range[1] for kind in mr], dtype=float),
        yield_fit=KILO * _rows([kind.yield_force_fit or NO_YIELD for kind in mr], 4),
        stiffness=_rows([_by_axis(kind, "stiffness") for kind in types], 3),
        damping=_rows([_by_axis(kind, "damping") for kind in types], 3),
    )


def mount_turn(mount):
    """Return the matrix (3, 3) that turns the axes of a mount's section into those of its parent."""
    return Rotation.from_euler("xyz", mount.orientation or (0.0, 0.0, 0.0), degrees=True).as_matrix()


def _least_stiffness(kind):
    if kind.kind != "mr":
        return 1.0
    return KN_PER_MM * np.polyval(kind.stiffness_fit, np.linspace(0.0, kind.current_range[1], _FINE)).min()


def _by_axis(kind, what):
    if kind.kind == "mr":
        return (*getattr(kind, f"{what}_ratio"), 1.0)
    return kind.stiffness if what == "stiffness" else kind.damping_by_axis


def _rows(values, size):
    return np.array(values, dtype=float).reshape(-1, size)


@inlined
def mount_current(mounts, index, currents):
    """Return the current [A] of one mount, 0 of one without a coil."""
    return currents[index] if index < mounts.coils else 0.0


@inlined
def mount_deflection(mounts, motion, index, imposed, imposed_rate):
    """Return upper place (global), deflection l and its rate l_d in the mount's axes [Tao2025, hinge 8].

    `imposed` [m] and `imposed_rate` [m/s] are the displacement along z that the engine imposes across each mount of the
    powertrain in the paper's way of exciting it; both are zero otherwise.
    """
    body, parent, axes = mounts.body[index], mounts.parent[index], _axes(mounts, index)
    upper = point_place(motion, body, load3(mounts.upper, index))
    lower = point_place(motion, parent, load3(mounts.lower, index))
    # l_d = A7^T (v_B - v_26 - Om7 x (r_B - r_26)): the rate against the parent's own point at the same place
    relative = subtract(point_velocity(motion, body, upper), point_velocity(motion, parent, upper))
    x, y, z = rotate_back(axes, body_axes(motion, parent, subtract(upper, lower)))
    v_x, v_y, v_z = rotate_back(axes, body_axes(motion, parent, relative))
    excited = mounts.excited[index]
    return upper, (x, y, z - excited * imposed), (v_x, v_y, v_z - excited * imposed_rate)


@inlined
def _axes(mounts, index):
    a = mounts.axes[index]
    return (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8])


@inlined
def add_mounts(mounts, fields, motion, cuts, currents, imposed, imposed_rate):
    """Add the mounts' forces to bodies and parents; `imposed` as in `mount_deflection`."""
    for index in range(mounts.body.size):
        upper, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        force, _ = mount_force(mounts, fields, index, mount_current(mounts, index, currents), l, l_d)
        _push(mounts, motion, cuts, index, upper, force)


@inlined
def push_mounts(mounts, motion, cuts, forces):
    """Add the mounts' forces (m, 3) [N], in their own axes, where somebody has found them already."""
    for index in range(mounts.body.size):
        upper = point_place(motion, mounts.body[index], load3(mounts.upper, index))
        _push(mounts, motion, cuts, index, upper, load3(forces, index))


@inlined
def _push(mounts, motion, cuts, index, upper, force):
    force = rotate(rotation(motion, mounts.parent[index]), rotate(_axes(mounts, index), force))
    apply_force(cuts, motion, mounts.body[index], upper, force)
    apply_force(cuts, motion, mounts.parent[index], upper, scale(-1.0, force))


@kernel
def observe_mounts(mounts, fields, motion, coils, imposed, imposed_rate, sample):
    """Fill a `MountSample`, given the `coil.CoilState`."""
    for index in range(mounts.coils):
        sample.current[index] = coils.current[index]
    for index in range(mounts.body.size):
        current, axes = mount_current(mounts, index, coils.field), _axes(mounts, index)
        _, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        k, c = mount_axes(mounts, index, current)
        force, power = mount_force(mounts, fields, index, current, l, l_d)
        sample.stiffness[index], sample.damping[index] = k[2], c[2]
        store3(sample.deflection, index, rotate(axes, l))
        store3(sample.velocity, index, rotate(axes, l_d))
        store3(sample.force, index, rotate(axes, force))
        sample.dissipated_power[index] = power
