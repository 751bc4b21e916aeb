"""Any body of a tree as its root: an independent engine, and what is refused."""

import numpy as np
import pytest
from trackvib_sim.rui.reference.reroot import reroot, reroot_state
from trackvib_sim.rui.table import Body, Hinge

pytestmark = pytest.mark.slow(reason="solves each tree from every root in plain matrices")

ENGINES = 1e-9  # relative to the largest; rounding of products along up to 40 bodies leaves some 1e-12


@pytest.mark.cross_engine
@pytest.mark.parametrize("hundred", [0, 1, 2])
def test_random_trees_with_any_root_against_pinocchio(random_table, pinocchio, relative, form, hundred):
    """300 random trees of 2 to 40 bodies, a random body as root: accelerations against ABA, wrenches against RNEA."""
    for seed in range(5000 + 100 * hundred, 5100 + 100 * hundred):
        bodies, state, loads = random_table(seed, 2 + seed % 39)
        root = bodies[np.random.default_rng(seed).integers(len(bodies))].name
        case = reroot(bodies, root), *reroot_state(bodies, state, loads, root)
        for value, reference in zip(form(*case), pinocchio(*case), strict=True):
            assert relative(value, reference) < ENGINES, seed


@pytest.mark.property
def test_roots_that_cannot_be_are_refused():
    """A name that no body has, and a root behind an elastic hinge, are refused by what is wrong."""
    inertia = np.eye(3)
    bodies = [
        Body(1, "frame", 1.0, (0, 0, 0), inertia),
        Body(2, "engine", 1.0, (0, 0, 0), inertia, Hinge(12, "elastic", "frame", (1, 0, 0))),
        Body(3, "crank", 1.0, (0, 0, 0), inertia, Hinge(13, "revolute", "engine", (0, 0, 1))),
    ]
    with pytest.raises(ValueError, match="'wheel' must be one of frame, engine, crank"):
        reroot(bodies, "wheel")
    for name in ("engine", "crank"):
        with pytest.raises(ValueError, match=f"'{name}': the elastic hinge 12"):
            reroot(bodies, name)
