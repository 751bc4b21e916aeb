"""The shipped vehicle through every form of the method: an independent engine, and the paper's paths by number."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.reference.form_a import overall_transfer
from trackvib_sim.rui.reference.reroot import reroot, reroot_state

G = (0.0, 0.0, -9.81)
ENGINES = 1e-9  # of the largest entry
PAPER_ROOT = "recoil_part"  # from which [Tao2025] passes the transfer on to all other ends


@pytest.fixture(scope="module")
def from_the_gun(table, random_state, random_loads):
    """A function of a seed: the table with the paper's root, a random state and loads."""

    def make(seed):
        return reroot(table, PAPER_ROOT), *reroot_state(table, random_state(seed), random_loads(seed), PAPER_ROOT), G

    return make


def assert_same(found, reference, tolerance, seed):
    """Compare all accelerations and wrenches, forces and moments each to their largest entry."""
    pairs = [(part, getattr(found, part), getattr(reference, part)) for part in ("linear", "angular", "hinge")]
    pairs += [(part, found.wrench[:, k], reference.wrench[:, k])
              for part, k in (("force", slice(0, 3)), ("moment", slice(3, 6)))]  # fmt: skip
    for part, value, expected in pairs:
        error = np.max(np.abs(value - expected)) / np.max(np.abs(expected))
        assert error < tolerance, (part, seed)


@pytest.mark.slow(reason="hundreds of states in plain matrices")
@pytest.mark.cross_engine
def test_vehicle_against_pinocchio(table, random_state, random_loads, pinocchio, form):
    """100 random states of the vehicle, torques and external wrenches on all: accelerations (ABA), wrenches (RNEA)."""
    for seed in range(100):
        case = table, random_state(seed), random_loads(seed), G
        assert_same(form(*case), pinocchio(*case), ENGINES, seed)


@pytest.mark.slow(reason="many states in plain matrices")
@pytest.mark.cross_engine
def test_vehicle_from_the_paper_root_against_pinocchio(from_the_gun, pinocchio, form):
    """The same with the recoil part as root, of which the paper's transfer starts."""
    for seed in range(20):
        case = from_the_gun(seed)
        assert_same(form(*case), pinocchio(*case), ENGINES, seed)


@pytest.mark.literature
@pytest.mark.parametrize(
    ("tip", "path"),
    [
        (64, (10, 64)),  # sprocket
        (58, (11, 34, 46, 58)),  # front road wheel behind its arm
        (81, (33, 81)),  # idler
        (9, (8, 9)),  # powertrain
    ],
)
def test_paths_of_the_paper(from_the_gun, tip, path):
    """T of the first body and an end is the product of the elements in between that [Tao2025] writes."""
    transfer = overall_transfer(*from_the_gun(0))
    path = [1, 2, 3, 4, 5, 6, 7, *path]
    assert transfer.path(1, tip) == path
    product = np.eye(13)
    for element, after in zip(path, [*path[1:], None], strict=True):
        # the hull has one matrix for each hinge by which it can be entered
        product = product @ (transfer.U(element, hinge=after) if element == 7 else transfer.U(element))
    T = transfer.T(1, tip)
    assert_allclose(product, T, rtol=0, atol=1e-12 * np.abs(T).max())
    assert_allclose(transfer.block(("main", 1), ("tip", tip)), T, rtol=0, atol=1e-12 * np.abs(T).max())


@pytest.mark.literature
def test_first_input_of_the_hull_is_that_of_the_paper(from_the_gun):
    """The hull's U7 without further words is that of the paper's first input, which hinge 10 feeds."""
    transfer = overall_transfer(*from_the_gun(0))
    assert_allclose(transfer.U(7), transfer.U(7, hinge=10), rtol=0, atol=0)
