"""Vectors and rotations as plain tuples, so that the compiled sweeps keep them in registers.

A vector is (x, y, z). A matrix is its nine elements row by row. A symmetric matrix is (xx, yy, zz, xy, xz, yz).
An attitude is a unit quaternion (w, x, y, z) that turns body axes into global axes.
"""

import math

from .compiled import inlined


@inlined
def add(a, b):
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@inlined
def subtract(a, b):
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@inlined
def scale(factor, a):
    """Return factor * a."""
    return (factor * a[0], factor * a[1], factor * a[2])


@inlined
def dot(a, b):
    """Return the scalar product a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a, b):
    """Return the vector product a x b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@inlined
def rotate(m, a):
    """Return the matrix-vector product m a."""
    return (
        m[0] * a[0] + m[1] * a[1] + m[2] * a[2],
        m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
        m[6] * a[0] + m[7] * a[1] + m[8] * a[2],
    )


@inlined
def rotate_back(m, a):
    """Return the product of the transposed matrix with a."""
    return (
        m[0] * a[0] + m[3] * a[1] + m[6] * a[2],
        m[1] * a[0] + m[4] * a[1] + m[7] * a[2],
        m[2] * a[0] + m[5] * a[1] + m[8] * a[2],
    )


@inlined
def multiply(m, n):
    """Return the matrix product m n."""
    return (
        m[0] * n[0] + m[1] * n[3] + m[2] * n[6],
        m[0] * n[1] + m[1] * n[4] + m[2] * n[7],
        m[0] * n[2] + m[1] * n[5] + m[2] * n[8],
        m[3] * n[0] + m[4] * n[3] + m[5] * n[6],
        m[3] * n[1] + m[4] * n[4] + m[5] * n[7],
        m[3] * n[2] + m[4] * n[5] + m[5] * n[8],
        m[6] * n[0] + m[7] * n[3] + m[8] * n[6],
        m[6] * n[1] + m[7] * n[4] + m[8] * n[7],
        m[6] * n[2] + m[7] * n[5] + m[8] * n[8],
    )


@inlined
def axis_rotation(axis, s, c):
    """Return the rotation matrix about a unit axis by an angle of sine s and cosine c (Rodrigues' formula)."""
    x, y, z = axis
    dx, dy, dz = scale(1.0 - c, axis)
    return (
        c + dx * x, dx * y - s * z, dx * z + s * y,
        dx * y + s * z, c + dy * y, dy * z - s * x,
        dx * z - s * y, dy * z + s * x, c + dz * z,
    )  # fmt: skip


@inlined
def quaternion_matrix(q):
    """Return the rotation matrix of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    return (
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    )  # fmt: skip


@inlined
def turn_quaternion(q, rate, dt):
    """Return the attitude after turning for dt at a constant global angular velocity [rad/s], normalised."""
    half = 0.5 * dt * math.sqrt(dot(rate, rate))
    # sin(half)/half by series where it is close to 1, exact to rounding below 1e-4
    sinc = 1.0 - half * half / 6.0 if half < 1e-4 else math.sin(half) / half
    cw = math.cos(half)
    cx, cy, cz = scale(0.5 * dt * sinc, rate)
    w, x, y, z = q
    nw = cw * w - cx * x - cy * y - cz * z
    nx = cw * x + cx * w + cy * z - cz * y
    ny = cw * y + cy * w + cz * x - cx * z
    nz = cw * z + cz * w + cx * y - cy * x
    norm = 1.0 / math.sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    return (nw * norm, nx * norm, ny * norm, nz * norm)


@inlined
def turn_inertia(m, s):
    """Return m S m^T for a symmetric S, as a symmetric matrix."""
    # columns of m S
    a0 = m[0] * s[0] + m[1] * s[3] + m[2] * s[4]
    a1 = m[0] * s[3] + m[1] * s[1] + m[2] * s[5]
    a2 = m[0] * s[4] + m[1] * s[5] + m[2] * s[2]
    b0 = m[3] * s[0] + m[4] * s[3] + m[5] * s[4]
    b1 = m[3] * s[3] + m[4] * s[1] + m[5] * s[5]
    b2 = m[3] * s[4] + m[4] * s[5] + m[5] * s[2]
    c0 = m[6] * s[0] + m[7] * s[3] + m[8] * s[4]
    c1 = m[6] * s[3] + m[7] * s[1] + m[8] * s[5]
    c2 = m[6] * s[4] + m[7] * s[5] + m[8] * s[2]
    return (
        a0 * m[0] + a1 * m[1] + a2 * m[2],
        b0 * m[3] + b1 * m[4] + b2 * m[5],
        c0 * m[6] + c1 * m[7] + c2 * m[8],
        a0 * m[3] + a1 * m[4] + a2 * m[5],
        a0 * m[6] + a1 * m[7] + a2 * m[8],
        b0 * m[6] + b1 * m[7] + b2 * m[8],
    )


@inlined
def symmetric_product(s, a):
    """Return S a for a symmetric S."""
    return (
        s[0] * a[0] + s[3] * a[1] + s[4] * a[2],
        s[3] * a[0] + s[1] * a[1] + s[5] * a[2],
        s[4] * a[0] + s[5] * a[1] + s[2] * a[2],
    )


@inlined
def scale_symmetric(factor, s):
    """Return factor * S for a symmetric S."""
    return (factor * s[0], factor * s[1], factor * s[2], factor * s[3], factor * s[4], factor * s[5])


@inlined
def add_symmetric(s, t):
    """Return S + T for symmetric S and T."""
    return (s[0] + t[0], s[1] + t[1], s[2] + t[2], s[3] + t[3], s[4] + t[4], s[5] + t[5])


@inlined
def symmetric_inverse(s):
    """Return the inverse of a symmetric matrix, by its cofactors."""
    xx = s[1] * s[2] - s[5] * s[5]
    xy = s[4] * s[5] - s[3] * s[2]
    xz = s[3] * s[5] - s[4] * s[1]
    w = 1.0 / (s[0] * xx + s[3] * xy + s[4] * xz)
    return (
        w * xx, w * (s[0] * s[2] - s[4] * s[4]), w * (s[0] * s[1] - s[3] * s[3]),
        w * xy, w * xz, w * (s[3] * s[4] - s[0] * s[5]),
    )  # fmt: skip


@inlined
def vector(array):
    """Return the first three numbers of an array as a vector."""
    return (array[0], array[1], array[2])


@inlined
def load3(array, row):
    """Return row `row` of an (n, 3) array as a vector."""
    return (array[row, 0], array[row, 1], array[row, 2])


@inlined
def store3(array, row, a):
    """Write a vector to row `row` of an (n, 3) array."""
    array[row, 0] = a[0]
    array[row, 1] = a[1]
    array[row, 2] = a[2]
