"""Shapes of bodies: closed surfaces that look outwards, of the sizes that the vehicle's parameters tell."""

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.drawings.sprocket_drawing import tooth_profile
from trackvib_sim.scene.bodies import body_parts, even_density_sides, shoe_parts
from trackvib_sim.scene.shapes import Box, Cylinder, Part, Prism, extents, surface
from trackvib_sim.scene.teeth import tooth_outline
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import read_vehicle

HERE, COLOUR = (0.0, 0.0, 0.0), (0, 0, 0)
each_vehicle = pytest.mark.parametrize("name", vehicle_names())


def volume(shape):
    """The volume that a surface encloses, by the divergence theorem; negative where faces look inwards."""
    solid = surface(Part(shape, (0.3, -0.2, 0.1), COLOUR))
    a, b, c = np.moveaxis(solid.corners[solid.triangles], 1, 0)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


@pytest.mark.analytic
def test_surfaces_enclose_their_volume():
    """A box, a drum (of 32 corners) and a prism, all faces outwards."""
    assert volume(Box((2.0, 3.0, 0.5))) == pytest.approx(3.0)
    circle = 16.0 * np.sin(np.pi / 16.0) * 0.4**2
    assert volume(Cylinder(0.4, 0.25)) == pytest.approx(circle * 0.25)
    triangle = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    assert volume(Prism(triangle, 2.0)) == pytest.approx(1.0)
    sides, middle = extents(Prism(triangle, 2.0))
    np.testing.assert_allclose((sides, middle), ((1.0, 2.0, 1.0), (0.5, 0.0, 0.5)))


@pytest.mark.analytic
def test_even_density_gives_the_inertia_back(vehicle):
    """The box of a body has its inertia."""
    x, y, z = even_density_sides(vehicle.hull) ** 2
    np.testing.assert_allclose(vehicle.hull.mass * np.array([y + z, x + z, x + y]) / 12.0, vehicle.hull.inertia)


@pytest.mark.property
@each_vehicle
def test_every_body_has_its_shape(name):
    """All bodies of all vehicles; wheels of their radius, arms from pivot to axle, nothing below the road."""
    vehicle, _ = read_vehicle(find_vehicle(name))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    parts, table = body_parts(vehicle, system), {body.name: body for body in build_body_table(vehicle)}
    assert list(parts) == list(table) and all(parts.values())
    corners = {body: np.concatenate([surface(part).corners for part in listed]) for body, listed in parts.items()}
    assert np.hypot(*corners["left_wheel_1"][:, [0, 2]].T).max() == pytest.approx(vehicle.road_wheels.radius)
    assert np.hypot(*corners["right_idler"][:, [0, 2]].T).max() == pytest.approx(vehicle.idlers.radius)
    tip = system.tracks.sprockets.tip_radius
    assert np.hypot(*corners["left_sprocket"][:, [0, 2]].T).max() == pytest.approx(tip, rel=1e-3)
    axle = np.array(table["left_wheel_1"].hinge.place)
    assert np.linalg.norm(corners["left_arm_1"] - axle, axis=1).min() < 0.05
    assert corners["hull"][:, 2].min() >= -1e-9
    (plate, *_) = shoe_parts(vehicle)
    assert 0.5 * vehicle.tracks.pitch < plate.shape.sides[0] < vehicle.tracks.pitch


@pytest.mark.property
def test_teeth_are_those_of_the_drawing(vehicle, system):
    """The outline of a tooth lies on the profile that the drawing has of the whole sprocket."""
    sprockets = system.tracks.sprockets
    profile, outline = tooth_profile(sprockets, 0.0), tooth_outline(sprockets)
    middle = np.pi / sprockets.teeth  # of the first tooth, about +y
    turn = np.array([[np.cos(middle), np.sin(middle)], [-np.sin(middle), np.cos(middle)]])
    away = np.linalg.norm(outline @ turn.T - profile[:, None], axis=-1).min(axis=0)
    assert away.max() < 1e-9
