"""Symplectic Euler on the coordinates of a tree."""

from ...numerics.compiled import inlined
from ...numerics.spatial import turn_quaternion, vector
from .response import ResponseOffset


@inlined
def integrate(tree, state, response, dt):
    """Advance the state by dt with symplectic Euler: speeds by the accelerations, then places by the new speeds."""
    w = len(tree.lanes)
    for j in range(tree.parent.size):
        cells, free = response.cells[j], tree.free[j]
        hinge, hinge_rate = state.hinge[j * w : (j + 1) * w], state.hinge_rate[j * w : (j + 1) * w]
        if free < 0:
            for i in range(tree.width[0]):
                hinge_rate[i] += dt * cells[ResponseOffset.HINGE * w + i]
                hinge[i] += dt * hinge_rate[i]
            continue
        position, velocity, rate, q = (
            state.position[free],
            state.velocity[free],
            state.angular_velocity[free],
            state.attitude[free],
        )
        for k in range(3):
            velocity[k] += dt * (cells[(ResponseOffset.LINEAR + k) * w] + tree.gravity[k])
            rate[k] += dt * cells[(ResponseOffset.ANGULAR + k) * w]
            position[k] += dt * velocity[k]
        turned = turn_quaternion((q[0], q[1], q[2], q[3]), vector(rate), dt)
        for k in range(4):
            q[k] = turned[k]
