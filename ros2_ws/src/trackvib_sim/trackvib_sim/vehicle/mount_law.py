"""The force law of mounts, along their own axes: rubber, and the field of those with a coil.

An MR mount has stiffness k(I) and damping c(I) = 2 zeta(I) sqrt(k(I) m) along its z axis from the paper's fits, and
ratios to these along the other two [Tao2025]. Below the fits' valid range stiffness follows the fit down to zero
current, and damping falls to that of the rubber. A rubber mount has constants.

The rubber alone carries with the least k(I), that of no current. What a current adds belongs to the field, and
remembers:

    F = F_0 - k(0) l - f - c(I) l',    f' = dk(I) l',    dk(I) = k(I) - k(0)

At constant current from rest this is the paper's k(I) l. A fluid that yields has a yield force F_y(I): what the field
carries comes near it and goes no further, as in the model of Bouc and Wen with n = 1 and equal shape factors [Wen],

    f' = dk(I) l' (1 - |f| / F_y) while f grows, dk(I) l' while it goes back;  without F_y it grows without end.
 A rising current makes the field stiffer from where the mount
is then: f stays. A falling one takes its share of f away: f falls as dk does. The field holds f^2 / (2 dk), so either
way it loses energy, (1 - dk / dk') of it when it rises to dk' and as much when it falls from dk' to dk: the mount is
passive under any current. A mount at rest in the middle feels nothing of its field.

[Wen] Y.-K. Wen, "Method for random vibration of hysteretic systems", J. Eng. Mech. Div. ASCE 102 (1976) 249.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined, kernel
from ..numerics.spatial import dot, load3, scale, store3


class FieldState(NamedTuple):
    """What the fields of m mounts remember. They change in the middle of physics steps (`mount_energy`)."""

    place: np.ndarray  # (m, 3) deflection when they changed last, m
    force: np.ndarray  # (m, 3) f there, against the deflection, N
    stiffness: np.ndarray  # (m,) dk along z since, N/m; 0 of rubber mounts
    limit: np.ndarray  # (m,) F_y along z since, N; infinite where nothing yields


def new_field_state(m):
    """Return the state of m mounts without a field."""
    return FieldState(np.zeros((m, 3)), np.zeros((m, 3)), np.zeros(m), np.full(m, np.inf))


@kernel
def mount_characteristics(mounts, index, current):
    """Return k(I) [N/m] and c(I) [N s/m] of one mount, the current [A] kept between zero and the end of the fits.

    Below their valid range stiffness follows the fit down to zero current, and damping falls to that of the rubber. Of
    a rubber mount both are one, for its `stiffness` and `damping` are no ratios.
    """
    if index >= mounts.coils:
        return 1.0, 1.0
    i = min(max(current, 0.0), mounts.highest[index])
    k, zeta = 0.0, 0.0
    for n in range(4):
        k = k * i + mounts.stiffness_fit[index, n]
        zeta = zeta * i + mounts.damping_ratio_fit[index, n]
    zeta = max(zeta, mounts.rubber_damping_ratio[index])
    return k, 2.0 * zeta * np.sqrt(k * mounts.carried_mass[index])


@inlined
def mount_axes(mounts, index, current):
    """Return stiffness [N/m] and damping [N s/m] of one mount along its own axes."""
    k, c = mount_characteristics(mounts, index, current)
    return scale(k, load3(mounts.stiffness, index)), scale(c, load3(mounts.damping, index))


@kernel
def lay_fields(mounts, currents, fields):
    """Let the fields begin with the springs at ease: then the mounts have k(I) until a current (c,) [A] changes."""
    for index in range(mounts.coils):
        fields.stiffness[index] = _field_stiffness(mounts, index, currents[index])
        fields.place[index] = 0.0
        fields.place[index, 2] = mounts.unloaded[index]
        fields.force[index] = 0.0
        fields.limit[index] = yield_force(mounts, index, currents[index])


@inlined
def _field_stiffness(mounts, index, current):
    return max(0.0, mount_characteristics(mounts, index, current)[0] - mounts.rubber[index])


@inlined
def yield_force(mounts, index, current):
    """Return F_y(I) [N] of one mount along z, infinite of one whose fluid does not yield."""
    i, force = min(max(current, 0.0), mounts.highest[index]), 0.0
    for n in range(4):
        force = force * i + mounts.yield_fit[index, n]
    return force


@kernel
def lead_field(stiffness, limit, force, way):
    """Return what the field carries [N] along one axis when it is led from `force` by a way [m]; exact for any way."""
    if not limit < np.inf:
        return force + stiffness * way
    if force * way < 0.0:
        if stiffness * abs(way) <= abs(force):
            return force + stiffness * way
        force, way = 0.0, way + force / stiffness
    size = abs(force) - (limit - abs(force)) * np.expm1(-stiffness * abs(way) / limit)
    return size if way > 0.0 else -size if way < 0.0 else force


@kernel
def _work(stiffness, limit, force, way):
    """Return the work [J] that leading it so takes."""
    if not limit < np.inf:
        return way * (force + 0.5 * stiffness * way)
    back = 0.0
    if force * way < 0.0:
        if stiffness * abs(way) <= abs(force):
            return way * (force + 0.5 * stiffness * way)
        back, force, way = -0.5 * force * force / stiffness, 0.0, way + force / stiffness
    ways = stiffness * abs(way) / limit
    return back + limit / stiffness * (limit * ways + (limit - abs(force)) * np.expm1(-ways))


@inlined
def field_force(mounts, fields, index, l):
    """Return f [N] of one mount at a deflection [m], along its axes."""
    dk, limit, ratio = fields.stiffness[index], fields.limit[index], mounts.stiffness[index]
    place, force = fields.place[index], fields.force[index]
    return (
        lead_field(dk * ratio[0], limit * ratio[0], force[0], l[0] - place[0]),
        lead_field(dk * ratio[1], limit * ratio[1], force[1], l[1] - place[1]),
        lead_field(dk * ratio[2], limit * ratio[2], force[2], l[2] - place[2]),
    )


@inlined
def _field_energy(mounts, index, dk, force):
    """Return what a field of this stiffness holds [J]; a force of none holds nothing."""
    energy = 0.0
    for k in range(3):
        stiffness = dk * mounts.stiffness[index, k]
        if stiffness > 0.0:
            energy += 0.5 * force[k] * force[k] / stiffness
    return energy


@inlined
def switch_field(mounts, fields, index, current, l):
    """Let the field of one mount follow its current [A] at a deflection [m].

    Returns the energy that it has turned into heat on the way there, and what it loses by the switching [J].
    """
    before, after = fields.stiffness[index], _field_stiffness(mounts, index, current)
    limit = yield_force(mounts, index, current)
    if after == before and not limit < np.inf:
        return 0.0, 0.0
    f, heat = field_force(mounts, fields, index, l), 0.0
    if fields.limit[index] < np.inf and before > 0.0:
        for k in range(3):
            ratio, force = mounts.stiffness[index, k], fields.force[index, k]
            if ratio > 0.0:
                stiffness = ratio * before
                heat += _work(stiffness, ratio * fields.limit[index], force, l[k] - fields.place[index, k])
                heat -= 0.5 * (f[k] * f[k] - force * force) / stiffness
    left = f if after >= before else scale(after / before, f)
    lost = _field_energy(mounts, index, before, f) - _field_energy(mounts, index, after, left)
    fields.stiffness[index], fields.limit[index] = after, limit
    store3(fields.place, index, l)
    store3(fields.force, index, left)
    return heat, lost


@inlined
def _yield_heat(mounts, fields, index, f, l_d):
    """Return the power [W] that the fluid turns into heat as it yields."""
    heat, limit = 0.0, fields.limit[index]
    if limit < np.inf:
        for k in range(3):
            if f[k] * l_d[k] > 0.0:
                heat += f[k] * l_d[k] * abs(f[k]) / (limit * mounts.stiffness[index, k])
    return heat


@inlined
def mount_force(mounts, fields, index, current, l, l_d):
    """Return the force on the body in the mount's axes [N], and the power that is turned into heat [W]."""
    rubber = scale(mounts.rubber[index], load3(mounts.stiffness, index))
    _, c = mount_axes(mounts, index, current)
    field, load = field_force(mounts, fields, index, l), mounts.load[index]
    damping = (c[0] * l_d[0], c[1] * l_d[1], c[2] * l_d[2])
    force = (
        load[0] - rubber[0] * l[0] - field[0] - damping[0],
        load[1] - rubber[1] * l[1] - field[1] - damping[1],
        load[2] - rubber[2] * (l[2] - mounts.unloaded[index]) - field[2] - damping[2],
    )
    return force, dot(damping, l_d) + _yield_heat(mounts, fields, index, field, l_d)


@inlined
def mount_stored_energy(mounts, fields, index, l):
    """Return the energy [J] that one mount stores, its preload included; zero where the springs are at ease."""
    rubber = scale(mounts.rubber[index], load3(mounts.stiffness, index))
    load, above = mounts.load[index], l[2] - mounts.unloaded[index]
    springs = 0.5 * (rubber[0] * l[0] ** 2 + rubber[1] * l[1] ** 2 + rubber[2] * above**2)
    springs += _field_energy(mounts, index, fields.stiffness[index], field_force(mounts, fields, index, l))
    return springs - load[0] * l[0] - load[1] * l[1] - load[2] * l[2]
