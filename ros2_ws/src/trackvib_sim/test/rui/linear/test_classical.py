"""The overall transfer matrix of the classical method is singular at every natural frequency, and only there."""

import numpy as np
import pytest
from trackvib_sim.rui.linear.classical import overall_matrix, smallest_singular_value
from trackvib_sim.rui.linear.modes import modes
from trackvib_sim.rui.linear.natural_modes import mode_shapes
from trackvib_sim.rui.linear.tree import linearise

from .linear_models import planar_vehicle, random_model, settled_vehicle
from .linear_reference import Dense

SINGULAR = 1e-11  # smallest over largest singular value, scaled; rounding leaves 1e-15, neighbours have 1e-5 and more


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", range(20))
def test_singular_at_every_natural_frequency(seed):
    """At each eigenvalue of the independent linearisation; half a per mille beside it no longer."""
    model = random_model(seed)
    tree = linearise(model)
    for value in Dense(model).eigenvalues():
        at, beside = (smallest_singular_value(overall_matrix(tree, -factor * value)) for factor in (1.0, 1.001))
        assert at < SINGULAR
        assert beside > 100.0 * at


@pytest.mark.property
@pytest.mark.parametrize("seed", range(8))
def test_singular_at_every_damped_pole(seed):
    """The same with damping at complex s."""
    model = random_model(seed)
    tree = linearise(model)
    for mode in modes(model):
        assert smallest_singular_value(overall_matrix(tree, mode.pole**2, mode.pole)) < SINGULAR


@pytest.mark.golden
def test_planar_vehicle():
    """At the three printed frequencies, of ten decimals, and not in the middle between two."""
    tree = linearise(planar_vehicle())
    printed = np.array([1.3347723895, 1.6245852422, 13.6182585716])
    at = [smallest_singular_value(overall_matrix(tree, -((2.0 * np.pi * f) ** 2))) for f in printed]
    between = [smallest_singular_value(overall_matrix(tree, -((2.0 * np.pi * f) ** 2))) for f in (1.48, 7.6)]
    assert max(at) < 1e-6 * min(between)


@pytest.mark.slow(reason="the classical forms of a whole vehicle")
@pytest.mark.property
def test_illustrative_vehicle():
    """41 bodies, 26 tips, 40 hinges: 26 x 6 + 40 unknowns, singular at all 22 frequencies."""
    tree = linearise(settled_vehicle())
    shapes = mode_shapes(tree)
    for value in shapes.omega_squared[24:]:
        matrix = overall_matrix(tree, -value)
        assert matrix.shape == (196, 196)
        assert smallest_singular_value(matrix) < SINGULAR
