"""The free end of the Riccati form: the root's acceleration from S x + s = 0."""

from ...numerics.compiled import inlined
from ...numerics.spatial import add, rotate_back, scale, subtract, symmetric_inverse, symmetric_product


@inlined
def solve_root(p, q, r, s_q, s_m):
    """Return a [m/s^2] and al [rad/s^2] of P a + Q al + s_q = 0, Q^T a + R al + s_m = 0, by eliminating a."""
    inverse = symmetric_inverse(p)
    # columns of P^-1 Q
    n = (
        symmetric_product(inverse, (q[0], q[3], q[6])),
        symmetric_product(inverse, (q[1], q[4], q[7])),
        symmetric_product(inverse, (q[2], q[5], q[8])),
    )
    # R - Q^T P^-1 Q: minus the inertia about the centre of percussion
    x, y, z = rotate_back(q, n[0]), rotate_back(q, n[1]), rotate_back(q, n[2])
    about = (r[0] - x[0], r[1] - y[1], r[2] - z[2], r[3] - y[0], r[4] - z[0], r[5] - z[1])
    free = symmetric_product(inverse, s_q)
    al = symmetric_product(symmetric_inverse(about), subtract(rotate_back(q, free), s_m))
    turning = add(add(scale(al[0], n[0]), scale(al[1], n[1])), scale(al[2], n[2]))
    return scale(-1.0, add(free, turning)), al
