"""Solids that bodies are drawn with, and their surfaces."""

from typing import NamedTuple

import numpy as np

_AROUND = 32  # corners of a circle


class Box(NamedTuple):
    """A cuboid around its origin."""

    sides: tuple  # along x, y and z, m


class Cylinder(NamedTuple):
    """A disc or drum around its origin, its axis along y."""

    radius: float  # m
    width: float  # m


class Prism(NamedTuple):
    """An outline in x and z, star-shaped about its middle, as deep as `width` along y to both sides of the origin."""

    outline: np.ndarray  # (m, 2), m
    width: float  # m


class Part(NamedTuple):
    """A shape in its place on a body."""

    shape: object
    place: tuple  # of the shape's origin, body axes, m
    colour: tuple  # red, green, blue, 0 to 255
    turn: np.ndarray = np.eye(3)  # (3, 3), from the shape's axes into those of the body
    see_through: bool = False  # for what encloses others


class Surface(NamedTuple):
    """Flat faces between corners."""

    corners: np.ndarray  # (v, 3), m
    faces: list  # of tuples of numbers of corners, anticlockwise seen from outside

    @property
    def triangles(self):
        """Numbers (t, 3) of the corners of triangles that make up the faces."""
        fans = ([(face[0], b, c) for b, c in zip(face[1:], face[2:], strict=False)] for face in self.faces)
        return np.array([triangle for fan in fans for triangle in fan])


def surface(part):
    """Return the `Surface` of a `Part` in the axes of its body."""
    shape = part.shape
    if isinstance(shape, Box):
        x, z = 0.5 * shape.sides[0], 0.5 * shape.sides[2]
        outline, width = np.array([(x, z), (-x, z), (-x, -z), (x, -z)]), shape.sides[1]
    elif isinstance(shape, Cylinder):
        angle = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
        outline, width = shape.radius * np.stack((np.cos(angle), np.sin(angle)), axis=-1), shape.width
    else:
        outline, width = shape
    corners, faces = _extruded(outline, width)
    return Surface(corners @ part.turn.T + part.place, faces)


def _extruded(outline, width):
    """Corners and faces of an outline (m, 2) in x and z, anticlockwise seen from -y, that is drawn along y."""
    m = len(outline)
    corners = np.empty((2 * m, 3))
    corners[:, ::2] = np.tile(outline, (2, 1))
    corners[:m, 1], corners[m:, 1] = -0.5 * width, 0.5 * width
    following = [*range(1, m), 0]
    sides = [(k, k + m, after + m, after) for k, after in enumerate(following)]
    return corners, [tuple(range(m)), tuple(range(2 * m - 1, m - 1, -1)), *sides]


def extents(shape):
    """Return the sides (3,) of the cuboid around a shape, along its own axes [m], and its middle (3,) there [m]."""
    corners = surface(Part(shape, (0.0, 0.0, 0.0), (0, 0, 0))).corners
    low, high = corners.min(axis=0), corners.max(axis=0)
    return high - low, 0.5 * (low + high)
