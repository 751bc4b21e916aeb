"""Elastic hinges: bushings that hold a body in all six directions without constraining it."""

import math

from ...numerics.compiled import inlined, kernel
from ...numerics.spatial import add, cross, load3, multiply, rotate, rotate_back, scale, subtract
from .articulated import apply_wrench
from .kinematics import MotionOffset, motion_vector, point_place, point_velocity, rotation


@inlined
def apply_elastic_hinges(tree, motion, cuts):
    """Add the wrenches of all elastic hinges to both bodies."""
    hinges = tree.elastic
    for k in range(hinges.parent.size):
        parent, child = hinges.parent[k], hinges.child[k]
        force, moment = elastic_wrench(tree, motion, k)
        apply_wrench(cuts, child, force, moment)
        lever = subtract(
            motion_vector(motion, MotionOffset.ORIGIN, child), motion_vector(motion, MotionOffset.ORIGIN, parent)
        )
        moment = add(moment, cross(lever, force))
        apply_wrench(cuts, parent, scale(-1.0, force), scale(-1.0, moment))


@kernel
def elastic_wrench(tree, motion, k):
    """Return force [N] and moment about the child's origin [N m] of elastic hinge k on the child, global axes.

    In the parent's axes, force = -K displacement - C velocity of the child's origin against the parent's own point at
    the same place, moment likewise with the rotation vector. Both act at the child's origin, so that no couple is left.
    """
    hinges = tree.elastic
    shift, turned, velocity, rate = _deformation(tree, motion, k)
    axes = rotation(motion, hinges.parent[k])
    force = _bush(hinges.stiffness[k, :3], hinges.damping[k, :3], shift, velocity)
    moment = _bush(hinges.stiffness[k, 3:], hinges.damping[k, 3:], turned, rate)
    return rotate(axes, force), rotate(axes, moment)


@kernel
def elastic_energy(tree, motion, k):
    """Return what elastic hinge k stores [J] and the power that it turns into heat [W]; rotations are small."""
    stored, dissipated = 0.0, 0.0
    hinges = tree.elastic
    shift, turned, velocity, rate = _deformation(tree, motion, k)
    for i in range(3):
        stored += 0.5 * hinges.stiffness[k, i] * shift[i] ** 2 + 0.5 * hinges.stiffness[k, 3 + i] * turned[i] ** 2
        dissipated += hinges.damping[k, i] * velocity[i] ** 2 + hinges.damping[k, 3 + i] * rate[i] ** 2
    return stored, dissipated


@kernel
def _deformation(tree, motion, k):
    """Displacement, rotation vector and the rates of both, in the parent's axes."""
    parent, child = tree.elastic.parent[k], tree.elastic.child[k]
    axes, origin = rotation(motion, parent), motion_vector(motion, MotionOffset.ORIGIN, child)
    arm = rotate_back(axes, subtract(origin, motion_vector(motion, MotionOffset.ORIGIN, parent)))
    velocity = subtract(point_velocity(motion, child, origin), point_velocity(motion, parent, origin))
    rate = subtract(
        motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, child),
        motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, parent),
    )
    turned = rotation_vector(_relative(axes, rotation(motion, child)))
    shift = subtract(arm, load3(tree.elastic.place, k))
    return shift, turned, rotate_back(axes, velocity), rotate_back(axes, rate)


@kernel
def elastic_place(tree, motion, k):
    """Return the global place of the hinge point on the parent [m]."""
    return point_place(motion, tree.elastic.parent[k], load3(tree.elastic.place, k))


@kernel
def rotation_vector(m):
    """Return axis times angle [rad] of a rotation matrix, for angles well below half a turn."""
    twice_sine = (m[7] - m[5], m[2] - m[6], m[3] - m[1])
    cosine = 0.5 * (m[0] + m[4] + m[8] - 1.0)
    sine = 0.5 * math.sqrt(twice_sine[0] ** 2 + twice_sine[1] ** 2 + twice_sine[2] ** 2)
    # angle / sine by series where both vanish
    factor = 0.5 + sine * sine / 12.0 if sine < 1e-4 else 0.5 * math.atan2(sine, cosine) / sine
    return scale(factor, twice_sine)


@kernel
def _relative(a, b):
    """A^T B."""
    return multiply((a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]), b)


@kernel
def _bush(stiffness, damping, displacement, velocity):
    return (
        -stiffness[0] * displacement[0] - damping[0] * velocity[0],
        -stiffness[1] * displacement[1] - damping[1] * velocity[1],
        -stiffness[2] * displacement[2] - damping[2] * velocity[2],
    )
