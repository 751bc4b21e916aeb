"""Finding a state of rest: closed forms, the illustrative vehicle, random trees, and what has none."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from trackvib_sim.rui.linear.equilibrium import check_equilibrium, find_equilibrium
from trackvib_sim.rui.linear.model import GroundSpring, LinearModel
from trackvib_sim.rui.state import rest_state
from trackvib_sim.rui.table import Body, Hinge

from .linear_models import illustrative_vehicle, random_model
from .linear_reference import Dense


def arm(stiffness, free):
    """An arm of 2 kg, 0.5 m on a held root, about y: gravity against a torsion spring."""
    table = [
        Body(0, "root", 1.0, (0, 0, 0), np.eye(3)),
        Body(1, "arm", 2.0, (0.5, 0, 0), 0.1 * np.eye(3), Hinge(1, "revolute", "root", (0, 0, 0), (0, 1, 0))),
    ]
    return LinearModel(table, rest_state(table), stiffness=[0, stiffness], free=[0.0, free], fixed_root=True)


@pytest.mark.analytic
def test_hanging_mass():
    """m g / k below the zero place of the spring, which is above its point of the body."""
    table = [Body(0, "mass", 4.0, (0, 0, 0), np.eye(3))]
    spring = GroundSpring("mass", (0, 0, 0.3), 500.0 * np.eye(3), place=(1.0, 2.0, 3.0))
    found = find_equilibrium(LinearModel(table, rest_state(table), springs=(spring,)))
    assert_allclose(found.state.position[0], [1.0, 2.0, 3.0 - 0.3 - 4.0 * 9.81 / 500.0], atol=1e-9)
    assert_allclose(found.springs[0].force, [0.0, 0.0, 4.0 * 9.81], atol=1e-6)


@pytest.mark.analytic
def test_nothing_holds_it_sideways():
    """A block on two upright springs sinks and tilts, and does not drift where no spring holds it."""
    table = [Body(0, "block", 4.0, (0.1, 0, 0), np.eye(3))]
    up = np.diag([0.0, 0.0, 500.0])
    springs = tuple(GroundSpring("block", (x, 0, 0), up, place=(x, 0, 0)) for x in (-1.0, 1.0))
    state = find_equilibrium(LinearModel(table, rest_state(table), springs=springs)).state
    assert_allclose(state.position[0, 2], -4.0 * 9.81 / 1000.0, atol=1e-9)
    # each spring carries its part: the difference in height is sin(pitch) times the distance
    pitch = 2.0 * np.arcsin(state.attitude[0, 2])
    assert_allclose(500.0 * 2.0 * np.sin(pitch), 4.0 * 9.81 * 0.1, rtol=1e-6)
    assert_allclose(state.position[0, 1], 0.0, atol=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("stiffness, free", [(30.0, 0.0), (12.0, -0.4), (200.0, 1.0)])
def test_arm_on_torsion_spring(stiffness, free):
    """m g l cos(th) = k (th - free), th positive downwards."""
    found = find_equilibrium(arm(stiffness, free))
    expected = brentq(lambda th: 2.0 * 9.81 * 0.5 * np.cos(th) - stiffness * (th - free), -1.0, 1.6, xtol=1e-14)
    assert_allclose(found.state.hinge[1], expected, rtol=1e-9)


@pytest.mark.analytic
def test_arm_without_spring_hangs_down():
    """Weight alone holds it: from a quarter turn to straight down."""
    assert_allclose(find_equilibrium(arm(0.0, 0.0)).state.hinge[1], np.pi / 2.0, atol=1e-8)


@pytest.mark.golden
def test_illustrative_vehicle():
    """Hull -0.0896 m, arms -11.28 to -12.56 deg, powertrain -0.0608 deg; wheels, rollers, sprockets stay at zero."""
    found = find_equilibrium(illustrative_vehicle())
    rows = {body.name: row for row, body in enumerate(found.bodies)}
    assert_allclose(found.state.position[0, 1], -0.0896, atol=0.51e-4)
    angles = np.degrees(found.state.hinge)
    for side in ("left", "right"):
        assert_allclose([angles[rows[f"arm {side} {k}"]] for k in (1, 6)], [-11.28, -12.56], atol=0.51e-2)
    assert_allclose(angles[rows["powertrain"]], -0.0608, atol=0.51e-4)
    spinning = [row for name, row in rows.items() if name.startswith(("wheel", "idler", "sprocket", "roller"))]
    assert len(spinning) == 24
    assert np.all(found.state.hinge[spinning] == 0.0)
    assert np.abs(Dense(found).load).max() < 1e-6 * 40880 * 9.81


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", range(20))
def test_pushed_random_trees_come_to_rest(seed):
    """Twenty newtons more, one spring less: then the independent route has no generalised force left."""
    model = random_model(seed)
    force = np.zeros((len(model.bodies), 3))
    force[0] = 20.0, -10.0, 5.0
    springs = tuple(spring for spring in model.springs if len(spring.stiffness) == 3)
    pushed = replace(model, springs=springs, loads=model.loads._replace(force=force))
    assert np.abs(Dense(pushed).load).max() > 10.0
    found = find_equilibrium(pushed)
    assert np.abs(Dense(found).load).max() < 1e-6
    assert Dense(found).eigenvalues()[0] > 0.0  # and stable it is
    check_equilibrium(found)


@pytest.mark.property
def test_no_rest_in_free_fall():
    """A free body without support cannot rest; the message names it."""
    table = [Body(0, "stone", 1.0, (0, 0, 0), np.eye(3))]
    with pytest.raises(ValueError, match="body 'stone': acceleration is -9.81"):
        find_equilibrium(LinearModel(table, rest_state(table)))


@pytest.mark.property
def test_speeds_are_refused():
    """A state with speeds is no state of rest."""
    table = [Body(0, "stone", 1.0, (0, 0, 0), np.eye(3))]
    with pytest.raises(ValueError, match="state's velocity is .* must be zero"):
        LinearModel(table, rest_state(table)._replace(velocity=np.ones((1, 3))))
