"""What the choice of root, order, numbers and global frame must not change, in all forms of the method."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.reference.reroot import reroot, reroot_state
from trackvib_sim.rui.state import Accelerations, free_bodies

GRAVITY = np.array([0.3, -0.2, -9.81])
EVERY_KIND = ("revolute", "prismatic", "locked", "elastic", "prescribed")
ROUNDING = 1e-9  # relative to the largest; Forms A and X multiply along paths of up to 25 bodies
CASES = {"seed": st.integers(0, 2**32 - 1), "size": st.integers(2, 25)}
FEW = settings(max_examples=40)


def assert_same(found, expected):
    """Compare `Accelerations`, forces and moments of the wrenches apart, each to its largest entry (1 at least)."""
    for part, value, reference in zip(("linear", "angular", "hinge", "force", "moment"),
                                      _parts(found), _parts(expected), strict=True):  # fmt: skip
        size = max(np.max(np.abs(reference)), 1.0)
        assert np.max(np.abs(value - reference)) < ROUNDING * size, part


def _parts(found):
    return *found[:3], found.wrench[:, :3], found.wrench[:, 3:]


@pytest.mark.slow(reason="forty trees, whose root is changed, in every form")
@pytest.mark.property
@FEW
@given(**CASES)
def test_root_does_not_matter(random_table, form, seed, size):
    """Another root moves origins and turns hinges round; every body and every hinge moves and carries as before."""
    bodies, state, loads = random_table(seed, size, EVERY_KIND)
    root = _random_root(bodies, np.random.default_rng(seed))
    again = reroot(bodies, root)
    before, after = place_bodies(bodies, state), place_bodies(again, reroot_state(bodies, state, loads, root)[0])
    found = form(bodies, state, loads, GRAVITY)
    rows = [[body.name for body in bodies].index(body.name) for body in again]
    expected = Accelerations(*(np.zeros_like(part) for part in found))
    of_hinge = {body.hinge.number: row for row, body in enumerate(bodies) if body.hinge is not None}
    for new, old in enumerate(rows):
        arm, om, al = after.origin[new] - before.origin[old], before.angular_velocity[old], found.angular[old]
        expected.linear[new] = found.linear[old] + np.cross(al, arm) + np.cross(om, np.cross(om, arm))
        expected.angular[new] = al
        if again[new].hinge is None:
            continue
        row = of_hinge[again[new].hinge.number]
        expected.hinge[new] = found.hinge[row]
        force, moment = found.wrench[row, :3], found.wrench[row, 3:]
        if row != old:
            # what was the parent is the child now, and the point is the one on the old child
            moment = -(moment + np.cross(before.hinge_point[row] - after.hinge_point[new], force))
            force = -force
        expected.wrench[new] = *force, *moment
    assert_same(form(again, *reroot_state(bodies, state, loads, root), GRAVITY), expected)


def _random_root(bodies, random):
    """The name of a body that no elastic hinge separates from the root."""
    fit = {bodies[0].name}
    for body in bodies[1:]:
        if body.hinge.kind != "elastic" and body.hinge.parent in fit:
            fit.add(body.name)
    return str(random.choice(sorted(fit)))


@pytest.mark.property
@FEW
@given(**CASES)
def test_coming_back_to_the_root_changes_nothing(random_table, form, seed, size):
    """From the first root to another and back, only the origins on the way have moved."""
    bodies, state, loads = random_table(seed, size, EVERY_KIND)
    there = _random_root(bodies, np.random.default_rng(seed))
    again, moved = reroot(bodies, there), reroot_state(bodies, state, loads, there)
    back, returned = reroot(again, bodies[0].name), reroot_state(again, *moved, bodies[0].name)
    old = {body.name: row for row, body in enumerate(bodies)}
    rows = [old[body.name] for body in back]
    for body, row in zip(back, rows, strict=True):
        one, other = body.hinge, bodies[row].hinge
        assert (one and (one.number, one.parent, one.kind)) == (other and (other.number, other.parent, other.kind))
    found, expected = form(back, *returned, GRAVITY), form(bodies, state, loads, GRAVITY)
    assert np.max(np.abs(found.angular - expected.angular[rows])) < ROUNDING * np.max(np.abs(expected.angular))
    assert np.max(np.abs(found.hinge - expected.hinge[rows])) < ROUNDING * max(np.max(np.abs(expected.hinge)), 1.0)


@pytest.mark.property
@FEW
@given(**CASES)
def test_order_and_numbers_do_not_matter(random_table, form, seed, size):
    """Rows in any order with parents before children, and other numbers, give the same result in that order."""
    bodies, state, loads = random_table(seed, size, EVERY_KIND)
    random = np.random.default_rng(seed)
    rows = _random_order(bodies, random)
    numbers, hinge_numbers = random.permutation(size), random.permutation(size)
    other = [
        replace(body, number=int(numbers[k]), hinge=body.hinge and replace(body.hinge, number=int(hinge_numbers[k])))
        for k, body in enumerate(bodies[row] for row in rows)
    ]
    free = [free_bodies(bodies).index(row) for row in rows if row in free_bodies(bodies)]
    reordered = type(state)(*(part[free] for part in state[:4]), *(part[rows] for part in state[4:]))
    found = form(other, reordered, type(loads)(*(part[rows] for part in loads)), GRAVITY)
    expected = form(bodies, state, loads, GRAVITY)
    assert_same(found, Accelerations(*(part[rows] for part in expected)))


def _random_order(bodies, random):
    """Rows in a random order, parents before children."""
    rows, placed, left = [0], {bodies[0].name}, set(range(1, len(bodies)))
    while left:
        row = int(random.choice(sorted(row for row in left if bodies[row].hinge.parent in placed)))
        rows.append(row)
        placed.add(bodies[row].name)
        left.remove(row)
    return rows


@pytest.mark.property
@FEW
@given(**CASES)
def test_orientation_of_the_global_frame_does_not_matter(random_table, form, seed, size):
    """Attitude, places, speeds, gravity and loads turned together turn the result."""
    bodies, state, loads = random_table(seed, size, EVERY_KIND)
    turn = Rotation.random(rng=np.random.default_rng(seed))
    found = form(bodies, state, loads, GRAVITY)
    turned = state._replace(
        position=turn.apply(state.position),
        attitude=(turn * Rotation.from_quat(state.attitude, scalar_first=True)).as_quat(scalar_first=True),
        velocity=turn.apply(state.velocity),
        angular_velocity=turn.apply(state.angular_velocity),
    )
    turned_loads = loads._replace(force=turn.apply(loads.force), moment=turn.apply(loads.moment))
    wrench = np.hstack((turn.apply(found.wrench[:, :3]), turn.apply(found.wrench[:, 3:])))
    expected = Accelerations(turn.apply(found.linear), turn.apply(found.angular), found.hinge, wrench)
    assert_same(form(bodies, turned, turned_loads, turn.apply(GRAVITY)), expected)


@pytest.mark.property
@FEW
@given(**CASES)
def test_place_and_speed_of_the_global_frame_do_not_matter(random_table, form, seed, size):
    """Seen from a frame some 100 m away that moves steadily at some 10 m/s, everything accelerates as before."""
    bodies, state, loads = random_table(seed, size, EVERY_KIND)
    random = np.random.default_rng(seed)
    away = state._replace(
        position=state.position + 100.0 * random.normal(size=3),
        velocity=state.velocity + 10.0 * random.normal(size=3),
    )
    assert_same(form(bodies, away, loads, GRAVITY), form(bodies, state, loads, GRAVITY))
