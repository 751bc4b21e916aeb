"""Magnetorheological mounts between hull and powertrain, parallel to hinge 8 [Tao2025].

The force law in one place: stiffness k(I) and damping c(I) = 2 zeta(I) sqrt(k(I) m) from the paper's fits, used only
inside their valid range, other axes as ratios of the vertical one. Force and reaction act at the same point (the upper
end), so that the pair carries no couple; the paper moves the reaction to the lower end instead, which would.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import load3, rotate, scale, store3, subtract, vector
from ..rui.sweeps.articulated import apply_force
from ..rui.sweeps.kinematics import body_axes, point_place, point_velocity, rotation

KN_PER_MM = 1e6  # N/m


class MrMounts(NamedTuple):
    """The two mounts; index 0 is the left one."""

    hull: int  # rows in the tree
    powertrain: int
    upper: np.ndarray  # (2, 3) upper ends in the powertrain, m
    lower: np.ndarray  # (2, 3) lower ends in the hull, m
    stiffness_fit: np.ndarray  # (4,) N/m, highest power of I first
    damping_ratio_fit: np.ndarray  # (4,)
    carried_mass: float  # kg
    static_load: float  # N
    lowest_current: float  # A, valid range of the fits
    highest_current: float
    stiffness_ratio: np.ndarray  # (3,) x, y, z
    damping_ratio: np.ndarray  # (3,)


class MountSample(NamedTuple):
    """State of both mounts at one instant, vectors in hull axes; k and c are those of the field."""

    current: np.ndarray  # (2,) in the coil, A
    stiffness: np.ndarray  # (2,) vertical, N/m
    damping: np.ndarray  # (2,) vertical, N s/m
    deflection: np.ndarray  # (2, 3) m
    velocity: np.ndarray  # (2, 3) m/s
    force: np.ndarray  # (2, 3) on the powertrain, N
    dissipated_power: np.ndarray  # (2,) W


def new_mount_sample():
    """Return room for the state of both mounts."""
    shapes = (2, 2, 2, (2, 3), (2, 3), (2, 3), 2)
    return MountSample(*(np.zeros(shape) for shape in shapes))


def build_mr_mounts(vehicle, rows):
    """Return the record for the vehicle; both ends lie at one place when every hinge is at zero."""
    m = vehicle.mr_mounts
    x, y, z = m.place
    upper = np.array([[x, y, z], [x, -y, z]])
    return MrMounts(
        hull=rows["hull"],
        powertrain=rows["powertrain"],
        upper=upper,
        lower=upper + np.array(vehicle.powertrain.place),
        stiffness_fit=KN_PER_MM * np.array(m.stiffness_fit),
        damping_ratio_fit=np.array(m.damping_ratio_fit),
        carried_mass=m.carried_mass,
        static_load=m.static_load,
        lowest_current=m.current_range[0],
        highest_current=m.current_range[1],
        stiffness_ratio=np.array([*m.stiffness_ratio, 1.0]),
        damping_ratio=np.array([*m.damping_ratio, 1.0]),
    )


@kernel
def mount_characteristics(mounts, current):
    """Return k(I) [N/m] and c(I) [N s/m] of one mount, the current [A] clamped to the valid range of the fits."""
    i = min(max(current, mounts.lowest_current), mounts.highest_current)
    k, zeta = 0.0, 0.0
    for n in range(4):
        k = k * i + mounts.stiffness_fit[n]
        zeta = zeta * i + mounts.damping_ratio_fit[n]
    # a fit must never become an energy source
    return k, 2.0 * max(zeta, 0.0) * np.sqrt(k * mounts.carried_mass)


@kernel
def mount_axes(mounts, current):
    """Return stiffness [N/m] and damping [N s/m] of one mount along x, y and z of the hull."""
    k, c = mount_characteristics(mounts, current)
    return scale(k, vector(mounts.stiffness_ratio)), scale(c, vector(mounts.damping_ratio))


@kernel
def mount_deflection(mounts, motion, index, imposed, imposed_rate):
    """Return upper place (global), deflection l and its rate l_d in hull axes [Tao2025, hinge 8].

    `imposed` [m] and `imposed_rate` [m/s] are the vertical displacement that the engine imposes across each mount in
    the paper's way of exciting the powertrain; both are zero otherwise.
    """
    upper = point_place(motion, mounts.powertrain, load3(mounts.upper, index))
    lower = point_place(motion, mounts.hull, load3(mounts.lower, index))
    # l_d = A7^T (v_B - v_26 - Om7 x (r_B - r_26)): the rate against the hull's own point at the same place
    relative = subtract(point_velocity(motion, mounts.powertrain, upper), point_velocity(motion, mounts.hull, upper))
    x, y, z = body_axes(motion, mounts.hull, subtract(upper, lower))
    v_x, v_y, v_z = body_axes(motion, mounts.hull, relative)
    return upper, (x, y, z - imposed), (v_x, v_y, v_z - imposed_rate)


@kernel
def mount_force(mounts, current, l, l_d):
    """Return the force on the powertrain in hull axes [N] and the power that the damping turns into heat [W]."""
    k, c = mount_characteristics(mounts, current)
    r_k, r_c = mounts.stiffness_ratio, mounts.damping_ratio
    damping = (c * r_c[0] * l_d[0], c * r_c[1] * l_d[1], c * r_c[2] * l_d[2])
    force = (
        -k * r_k[0] * l[0] - damping[0],
        -k * r_k[1] * l[1] - damping[1],
        mounts.static_load - k * r_k[2] * l[2] - damping[2],
    )
    return force, damping[0] * l_d[0] + damping[1] * l_d[1] + damping[2] * l_d[2]


@kernel
def mount_stored_energy(mounts, current, l):
    """Return the energy [J] that one mount stores, its preload included; zero at its unloaded place."""
    k, _ = mount_axes(mounts, current)
    return 0.5 * (k[0] * l[0] ** 2 + k[1] * l[1] ** 2 + k[2] * l[2] ** 2) - mounts.static_load * l[2]


@kernel
def add_mounts(mounts, motion, cuts, currents, imposed, imposed_rate):
    """Add the mounts' forces to powertrain and hull; `imposed` as in `mount_deflection`."""
    for index in range(2):
        upper, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        force, _ = mount_force(mounts, currents[index], l, l_d)
        force = rotate(rotation(motion, mounts.hull), force)
        apply_force(cuts, motion, mounts.powertrain, upper, force)
        apply_force(cuts, motion, mounts.hull, upper, scale(-1.0, force))


@kernel
def observe_mounts(mounts, motion, coils, imposed, imposed_rate, sample):
    """Fill a `MountSample`, given the `coil.CoilState`."""
    for index in range(2):
        _, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        k, c = mount_characteristics(mounts, coils.field[index])
        force, power = mount_force(mounts, coils.field[index], l, l_d)
        sample.current[index], sample.stiffness[index], sample.damping[index] = coils.current[index], k, c
        store3(sample.deflection, index, l)
        store3(sample.velocity, index, l_d)
        store3(sample.force, index, force)
        sample.dissipated_power[index] = power
