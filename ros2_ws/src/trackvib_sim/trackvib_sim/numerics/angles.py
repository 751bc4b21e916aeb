"""Angles and their sines in plain arithmetic: the same bits on every machine, and no branch between lanes."""

import math

import numpy as np

from .compiled import exact

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
