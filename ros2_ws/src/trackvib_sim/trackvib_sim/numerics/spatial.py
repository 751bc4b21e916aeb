"""Vectors and rotations as plain tuples, so that the compiled sweeps keep them in registers.

A vector is (x, y, z). A matrix is its nine elements row by row. A symmetric matrix is (xx, yy, zz, xy, xz, yz).
An attitude is a unit quaternion (w, x, y, z) that turns body axes into global axes.
"""

import math

import numpy as np

from .compiled import exact, inlined


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


# pi / 2 in three parts, the first two with so few digits that whole multiples of them are exact [fdlibm]
_QUARTER_TURN = (1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
_QUARTERS_PER_RADIAN = 0.63661977236758134308


@exact
def sine_cosine(x):
    """Return the sine and cosine of an angle of up to 1e6 rad, to the last digit but one and without a branch.

    The polynomials on an eighth of a turn are those of [fdlibm] (`k_sin.c`, `k_cos.c`).
    """
    quarters = np.floor(x * _QUARTERS_PER_RADIAN + 0.5)
    r = ((x - quarters * _QUARTER_TURN[0]) - quarters * _QUARTER_TURN[1]) - quarters * _QUARTER_TURN[2]
    z = r * r
    s = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10
    s = -1.98412698298579493134e-04 + z * (2.75573137070700676789e-06 + z * s)
    s = r + r * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * s))
    c = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11
    c = 2.48015872894767294178e-05 + z * (-2.75573143513906633035e-07 + z * c)
    c = 1.0 - 0.5 * z + z * z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * c))
    quarter = quarters - 4.0 * np.floor(0.25 * quarters)
    odd = (quarter == 1.0) | (quarter == 3.0)
    sine, cosine = c if odd else s, s if odd else c
    return -sine if quarter >= 2.0 else sine, -cosine if (quarter == 1.0) | (quarter == 2.0) else cosine


# Cephes' `atan.c`: atan(t) = t + t^3 P(t^2) / Q(t^2) up to t = 0.66
_ARCTAN_P = (
    -8.750608600031904122785e-01,
    -1.615753718733365076637e01,
    -7.500855792314704667340e01,
    -1.228866684490136173410e02,
    -6.485021904942025371773e01,
)
_ARCTAN_Q = (
    2.485846490142306297962e01,
    1.650270098316988542046e02,
    4.328810604912902668951e02,
    4.853903996359136964868e02,
    1.945506571482613964425e02,
)


@exact
def vector_angle(x, y):
    """Return the angle [rad] of a plane vector other than zero, to the last digit but one and without a branch.

    The quotient on an eighth of a turn is that of Cephes (`atan.c`).
    """
    larger, smaller = max(abs(x), abs(y)), min(abs(x), abs(y))
    # beyond a sixteenth of a turn the angle is taken from the diagonal
    far = smaller > 0.41421356237309503 * larger
    t = (smaller - larger if far else smaller) / (smaller + larger if far else larger)
    z, p, q = t * t, _ARCTAN_P, _ARCTAN_Q
    above = (((p[0] * z + p[1]) * z + p[2]) * z + p[3]) * z + p[4]
    below = ((((z + q[0]) * z + q[1]) * z + q[2]) * z + q[3]) * z + q[4]
    angle = t + t * z * (above / below) + (0.25 * math.pi if far else 0.0)
    angle = 0.5 * math.pi - angle if abs(y) > abs(x) else angle
    angle = math.pi - angle if x < 0.0 else angle
    return -angle if y < 0.0 else angle


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
