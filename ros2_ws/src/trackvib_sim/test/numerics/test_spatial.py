"""Vectors and matrices as tuples give what numpy's arrays give."""

import numpy as np
import pytest
from trackvib_sim.numerics import spatial

pytestmark = pytest.mark.cross_engine

RNG = np.random.default_rng(1)
A, B = RNG.normal(size=(2, 3))
M, N = RNG.normal(size=(2, 3, 3))
S = M @ M.T + np.eye(3)  # symmetric and far from singular


def symmetric(matrix):
    """Return the six numbers of a symmetric (3, 3) array."""
    return tuple(matrix[row, column] for row, column in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        (spatial.add(A, B), A + B),
        (spatial.subtract(A, B), A - B),
        (spatial.scale(2.5, A), 2.5 * A),
        (spatial.dot(A, B), A @ B),
        (spatial.cross(A, B), np.cross(A, B)),
        (spatial.rotate(M.ravel(), A), M @ A),
        (spatial.rotate_back(M.ravel(), A), M.T @ A),
        (spatial.multiply(M.ravel(), N.ravel()), (M @ N).ravel()),
        (spatial.symmetric_product(symmetric(S), A), S @ A),
        (spatial.symmetric_inverse(symmetric(S)), symmetric(np.linalg.inv(S))),
        (spatial.turn_inertia(M.ravel(), symmetric(S)), symmetric(M @ S @ M.T)),
    ],
)
def test_products_are_those_of_numpy(made, expected):
    """Up to rounding."""
    np.testing.assert_allclose(made, expected, rtol=1e-12, atol=1e-12)
