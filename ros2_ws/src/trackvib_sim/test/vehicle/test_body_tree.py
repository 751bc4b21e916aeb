"""The body table and the tree made of it: the numbers of the paper, and what is refused."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset
from trackvib_sim.rui.sweeps.tree import build_tree, rest_lanes
from trackvib_sim.rui.table import Hinge, check_table
from trackvib_sim.vehicle.body_tree import SIDES, build_body_table, wheel_name

# [Tao2025], numbering of the body subsystem: hinge -> (body towards the hull, body behind)
PAPER = {2: (3, 1), 4: (5, 3), 6: (7, 5), 8: (7, 9)}
HULL_SIDE = (64, *range(34, 40), *range(65, 69), 69, 76, *range(40, 46), *range(77, 81), 81)
PAPER |= {hinge: (7, body) for hinge, body in zip(range(10, 34), HULL_SIDE, strict=True)}
WHEELS = (*range(58, 64), *range(70, 76))
PAPER |= {hinge: pair for hinge, pair in zip(range(46, 58), zip(range(34, 46), WHEELS, strict=True), strict=True)}


@pytest.fixture(scope="module")
def origins(system, moved):
    """Origin of each row with every coordinate at zero."""
    return columns(moved(system.tree, rest_lanes(system.tree)), MotionOffset.ORIGIN, 3)


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
def test_vehicle_has_46_degrees_of_freedom(table, system):
    """Six of the hull and one of each of the 40 hinges, of which only the recoil part's is prismatic."""
    assert 6 + np.count_nonzero(system.tree.moves) == 46
    assert not any(body.hinge.prescribed for body in table[1:])
    assert [body.name for body in table[1:] if body.hinge.kind == "prismatic"] == ["recoil_part"]
    assert {body.hinge.kind for body in table[1:]} == {"revolute", "prismatic"}


@pytest.mark.literature
def test_free_ends_are_those_of_the_paper(table):
    """Nothing hangs behind the bodies 1, 9 and 58 to 81, and behind every other body something does."""
    parents = {body.hinge.parent for body in table if body.hinge}
    assert {body.number for body in table if body.name not in parents} == {1, 9, *range(58, 82)}


@pytest.mark.property
def test_total_mass_is_the_sum_of_the_file(vehicle, table):
    """Every mass of the vehicle file is in the tree as often as the vehicle has the part."""
    v = vehicle
    single = v.hull.mass + sum(body.mass for body in v.bodies.values()) + v.powertrain.mass
    side = 6 * (v.swing_arms.mass + v.road_wheels.mass) + v.sprockets.mass + 4 * v.carrier_rollers.mass + v.idlers.mass
    assert sum(body.mass for body in table) == pytest.approx(single + 2 * side, rel=1e-14)


@pytest.mark.property
def test_wheels_stand_where_the_file_says(vehicle, rows, origins):
    """At zero coordinates each wheel stands at its wheel_x and +-y, its centre one radius above the ground."""
    for side, sign in SIDES.items():
        for station in range(vehicle.swing_arms.stations):
            expected = vehicle.swing_arms.wheel_x[station], sign * vehicle.road_wheels.y, vehicle.road_wheels.radius
            assert_allclose(origins[rows[wheel_name(side, station)]], expected, atol=1e-14)


@pytest.mark.property
def test_right_side_mirrors_the_left(table, rows, origins):
    """Each left body has a right one of the same mass, mirrored in place, centre and inertia."""
    mirror = np.array([1.0, -1.0, 1.0])
    lefts = [body for body in table if body.number in (*range(34, 40), *range(58, 70))]
    assert len(lefts) == 18
    by_number = {body.number: body for body in table}
    for left in lefts:
        right = by_number[left.number + (6 if left.number < 46 else 12)]
        assert left.mass == right.mass
        assert_allclose(left.centre * mirror, right.centre)
        assert_allclose(origins[rows[left.name]] * mirror, origins[rows[right.name]])
        # products with y change sign
        assert_allclose(left.inertia * np.outer(mirror, mirror), right.inertia)


@pytest.mark.analytic
def test_wheels_are_discs(vehicle, table):
    """A road wheel has m r^2 / 2 about its axle and m (3 r^2 + w^2) / 12 across."""
    w = vehicle.road_wheels
    inertia = next(body.inertia for body in table if body.name == wheel_name(0, 0))
    across = w.mass * (3 * w.radius**2 + w.width**2) / 12
    assert_allclose(inertia, np.diag([across, w.mass * w.radius**2 / 2, across]), rtol=1e-15)


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
        (lambda body: replace(body, name="hull"), ("the name is already used",)),
        (lambda body: replace(body, hinge=None), ("root",)),
        (_hinge(kind="ball"), ("'ball'", "revolute, prismatic")),
        (_hinge(parent="moon"), ("'moon'", "known are hull")),
        (_hinge(axis=(0, 0, 0)), ("axis is (0, 0, 0)", "1e-06 to 1e+06 long")),
        (_hinge(axis=(0, 1e-300, 0)), ("axis is (0, 1e-300, 0)", "1e-06 to 1e+06 long")),
        (_hinge(axis=(0, 0)), ("axis is (0, 0)", "3 finite numbers")),
        (_hinge(axis=(0, 0, float("nan"))), ("axis is", "3 finite numbers")),
        (_hinge(place=(0.0, float("inf"), 0.0)), ("place is (0.0, inf, 0.0)", "3 finite numbers")),
        (_hinge(place=(0.0, "far", 0.0)), ("place is", "3 finite numbers")),
        (lambda body: replace(body, centre=(0.0, 0.0, float("nan"))), ("centre is", "3 finite numbers")),
        (lambda body: replace(body, mass=float("inf")), ("mass is inf kg", "finite")),
        (lambda body: replace(body, inertia=np.zeros((3, 3))), ("[0.0, 0.0, 0.0]", "> 0")),
        (_hinge(kind="locked", prescribed=True), ("locked hinge has no motion to prescribe",)),
        (_hinge(kind="elastic", prescribed=True), ("elastic hinge has no motion to prescribe",)),
        (_hinge(stiffness=(1.0, 0, 0, 0, 0, 0)), ("stiffness is for elastic hinges", "revolute hinge")),
        (_hinge(kind="prismatic", damping=(0, 0, 0, 0, 0, 1.0)), ("damping is for elastic hinges", "prismatic hinge")),
        (_hinge(kind="elastic", stiffness=(1.0, -2.0, 0, 0, 0, 0)), ("stiffness is [1.0, -2.0", "not be negative")),
        (_hinge(kind="elastic", damping=(0, 0, 0, 0, 0, -3.0)), ("damping is", "-3.0", "not be negative")),
        (_hinge(kind="elastic", stiffness=(1.0,) * 5), ("stiffness is", "6 finite numbers")),
        (_hinge(kind="elastic", damping=(float("inf"),) * 6), ("damping is", "6 finite numbers")),
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
    with pytest.raises(ValueError, match=re.escape(str(refused.value))):
        check_table(bodies)


@pytest.mark.property
def test_hinge_is_named_with_its_number(table):
    """Refusing a hinge names it by its number, too."""
    bodies = [
        replace(body, hinge=replace(body.hinge, place=(np.nan, 0, 0))) if body.name == "powertrain" else body
        for body in table
    ]
    with pytest.raises(ValueError, match=r"^hinge 8 of body 9 \(powertrain\): place is"):
        check_table(bodies)


@pytest.mark.property
def test_table_without_bodies_is_refused():
    """An empty table says that it is empty."""
    with pytest.raises(ValueError, match="no body.*at least the root"):
        build_tree([])


@pytest.mark.property
def test_table_must_begin_with_its_root(table):
    """A table whose first body has a hinge, or that names a later body as parent, is refused."""
    with pytest.raises(ValueError, match=r"body 5 \(turret\): the first body.*is the root"):
        check_table(table[1:])
    hung = replace(table[0], hinge=Hinge(1, "locked", "turret", (0, 0, 0)))
    with pytest.raises(ValueError, match=r"body 7 \(hull\): the first body.*is the root"):
        check_table([hung, *table[1:]])
    with pytest.raises(ValueError, match=r"body 3 \(gun_mount\): parent 'turret' must stand before it; known are hull"):
        check_table([table[0], table[2], table[1], *table[3:]])


@pytest.mark.property
@pytest.mark.parametrize("gravity", [(0.0, -9.81), (0.0, 0.0, 0.0, -9.81), -9.81, (0.0, 0.0, float("nan"))])
def test_gravity_of_other_than_three_numbers_is_refused(table, gravity):
    """Gravity is a vector of three finite numbers, and the refusal says what was given."""
    with pytest.raises(ValueError, match=re.escape(f"gravity is {np.array(gravity).tolist()}, must be three finite")):
        build_tree(table, gravity)


@pytest.mark.property
def test_impossible_inertia_of_a_vehicle_file_names_the_body(changed):
    """An inertia that no body has passes the file's own checks and is refused where the tree is built."""
    vehicle = changed("turret", inertia=[8500.0, 11000.0, 30000.0])
    with pytest.raises(ValueError, match=r"body 5 \(turret\).*principal moments"):
        build_tree(build_body_table(vehicle))


@pytest.mark.property
def test_axis_is_made_a_unit_vector(table, system, moved):
    """The length of a hinge's axis in the table does not matter."""
    bodies = [
        replace(body, hinge=replace(body.hinge, axis=tuple(7.0 * x for x in body.hinge.axis))) if body.hinge else body
        for body in table
    ]
    tree = build_tree(bodies, system.tree.gravity)
    assert_allclose(tree.body, system.tree.body, rtol=1e-15)
    axes = columns(moved(tree, rest_lanes(tree)), MotionOffset.HINGE_AXIS, 3)[tree.row[1:]]
    assert_allclose(axes, [body.hinge.axis for body in table[1:]], rtol=0, atol=1e-15)
