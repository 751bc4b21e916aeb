"""The body table and the tree made of it: the numbers of the paper, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.tree import SLIDE, build_tree, rest_state
from trackvib_sim.vehicle.body_tree import SIDES, STATIONS, body_table, wheel_name

# [Tao2025], numbering of the body subsystem: hinge -> (body towards the hull, body behind)
PAPER = {2: (3, 1), 4: (5, 3), 6: (7, 5), 8: (7, 9)}
HULL_SIDE = (64, *range(34, 40), *range(65, 69), 69, 76, *range(40, 46), *range(77, 81), 81)
PAPER |= {hinge: (7, body) for hinge, body in zip(range(10, 34), HULL_SIDE, strict=True)}
WHEELS = (*range(58, 64), *range(70, 76))
PAPER |= {hinge: pair for hinge, pair in zip(range(46, 58), zip(range(34, 46), WHEELS, strict=True), strict=True)}


@pytest.fixture(scope="module")
def system_at_zero(system, moved):
    """The motion record with every coordinate at zero."""
    return moved(system.tree, rest_state(system.tree))


@pytest.mark.literature
def test_bodies_and_hinges_are_those_of_the_paper(table):
    """41 bodies and 40 hinges carry the paper's numbers, and each hinge joins the two bodies that it does there."""
    number = {body.name: body.number for body in table}
    joined = {body.hinge.number: (number[body.hinge.parent], body.number) for body in table if body.hinge}
    assert joined == PAPER
    expected = {1, 3, 5, 7, 9, *range(34, 46), *range(58, 82)}
    assert len(table) == len(expected) == 41
    assert {body.number for body in table} == expected


@pytest.mark.literature
def test_vehicle_has_46_degrees_of_freedom(system):
    """Six of the hull and one of each of the 40 hinges, of which only the recoil part's is a slide."""
    assert 6 + len(system.tree.parent) - 1 == 46
    assert np.count_nonzero(system.tree.kind == SLIDE) == 1


@pytest.mark.literature
def test_free_ends_are_those_of_the_paper(table):
    """Nothing hangs behind the bodies 1, 9 and 58 to 81, and behind every other body something does."""
    parents = {body.hinge.parent for body in table if body.hinge}
    assert {body.number for body in table if body.name not in parents} == {1, 9, *range(58, 82)}


@pytest.mark.property
def test_total_mass_is_the_sum_of_the_file(vehicle, system):
    """Every mass of the vehicle file is in the tree as often as the vehicle has the part."""
    v = vehicle
    single = v.hull.mass + v.turret.mass + v.gun_mount.mass + v.recoil_part.mass + v.powertrain.mass
    side = 6 * (v.swing_arms.mass + v.road_wheels.mass) + v.sprockets.mass + 4 * v.carrier_rollers.mass + v.idlers.mass
    assert system.tree.mass.sum() == pytest.approx(single + 2 * side, rel=1e-14)


@pytest.mark.property
def test_wheels_stand_where_the_file_says(vehicle, rows, system_at_zero):
    """At zero coordinates each wheel stands at its wheel_x and +-y, its centre one radius above the ground."""
    for side, sign in SIDES.items():
        for station in range(STATIONS):
            expected = vehicle.swing_arms.wheel_x[station], sign * vehicle.road_wheels.y, vehicle.road_wheels.radius
            assert_allclose(system_at_zero.origin[rows[wheel_name(side, station)]], expected, atol=1e-14)


@pytest.mark.property
def test_right_side_mirrors_the_left(table, system, rows, system_at_zero):
    """Each left body has a right one of the same mass, mirrored in place, centre and inertia."""
    tree, mirror = system.tree, np.array([1.0, -1.0, 1.0])
    lefts = [body for body in table if body.number in (*range(34, 40), *range(58, 70))]
    assert len(lefts) == 18
    by_number = {body.number: rows[body.name] for body in table}
    for body in lefts:
        left, right = by_number[body.number], by_number[body.number + (6 if body.number < 46 else 12)]
        assert tree.mass[left] == tree.mass[right]
        assert_allclose(tree.centre[left] * mirror, tree.centre[right])
        assert_allclose(system_at_zero.origin[left] * mirror, system_at_zero.origin[right])
        # products with y change sign
        assert_allclose(tree.inertia[left] * (1, 1, 1, -1, 1, -1), tree.inertia[right])


@pytest.mark.analytic
def test_wheels_are_discs(vehicle, system, rows):
    """A road wheel has m r^2 / 2 about its axle and m (3 r^2 + w^2) / 12 across."""
    w = vehicle.road_wheels
    xx, yy, zz, *products = system.tree.inertia[rows[wheel_name(0, 0)]]
    assert yy == pytest.approx(w.mass * w.radius**2 / 2)
    assert xx == zz == pytest.approx(w.mass * (3 * w.radius**2 + w.width**2) / 12)
    assert products == [0.0, 0.0, 0.0]


def _hinge(**changes):
    return lambda body: replace(body, hinge=replace(body.hinge, **changes))


@pytest.mark.property
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda body: replace(body, mass=0.0), ("mass is 0.0 kg", "> 0")),
        (lambda body: replace(body, mass=float("nan")), ("mass is nan kg", "finite")),
        (lambda body: replace(body, inertia=np.diag([1.0, 1.0, 3.0])), ("[1.0, 1.0, 3.0]", "sum of the other two")),
        (lambda body: replace(body, inertia=np.diag([1.0, 1.0, -1.0])), ("-1.0", "> 0")),
        (lambda body: replace(body, inertia=np.full((3, 3), np.nan)), ("nan", "symmetric 3 x 3")),
        (lambda body: replace(body, inertia=np.eye(2)), ("symmetric 3 x 3",)),
        (lambda body: replace(body, inertia=np.eye(3) + [[0, 1, 0], [0, 0, 0], [0, 0, 0]]), ("symmetric",)),
        (lambda body: replace(body, name="hull"), ("the name is taken",)),
        (lambda body: replace(body, hinge=None), ("root",)),
        (_hinge(kind="ball"), ("'ball'", "revolute, slide")),
        (_hinge(parent="moon"), ("'moon'", "known are hull")),
        (_hinge(axis=(0, 0, 0)), ("axis is (0, 0, 0)", "not be zero")),
    ],
)
def test_impossible_bodies_are_refused(table, change, words):
    """A body that cannot be is refused with its number and name, the value and what is accepted."""
    bodies = list(table)
    bodies[1] = change(bodies[1])
    with pytest.raises(ValueError) as refused:
        build_tree(bodies)
    for word in (*words, f"body 5 ({bodies[1].name})"):
        assert word in str(refused.value)


@pytest.mark.property
def test_impossible_inertia_of_a_vehicle_file_names_the_body(changed):
    """An inertia that no body has passes the file's own checks and is refused where the tree is built."""
    vehicle = changed("turret", inertia=[8500.0, 11000.0, 30000.0])
    with pytest.raises(ValueError, match=r"body 5 \(turret\).*principal moments"):
        build_tree(body_table(vehicle))


@pytest.mark.property
def test_axis_is_made_a_unit_vector(table, system):
    """The length of a hinge's axis in the table does not matter."""
    bodies = [
        replace(body, hinge=replace(body.hinge, axis=tuple(7.0 * x for x in body.hinge.axis))) if body.hinge else body
        for body in table
    ]
    assert_allclose(build_tree(bodies).axis, system.tree.axis, rtol=1e-15)
