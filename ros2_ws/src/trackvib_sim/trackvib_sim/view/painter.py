"""A vehicle on its road as coloured polygons of a picture, the farthest first."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..scene.bodies import body_parts, shoe_parts
from ..scene.colours import of_load
from ..scene.mounts import mount_places
from ..scene.poses import left_axis, link_poses
from ..scene.shapes import surface
from ..vehicle.body_tree import SIDES, build_body_table

_EYE = np.array([5.5, 11.0, 4.0])  # of the camera, from the hull's place on the road, m
_TARGET = np.array([0.4, 0.0, 0.75])
_LIGHT = np.array([0.25, 0.45, 0.86])
_AROUND = 7.5  # m of road before and behind the hull
_DARKEST = 0.62  # of a colour, on faces away from the light


class Paint(NamedTuple):
    """What is to be painted, in this order; places in the picture's plane."""

    solid: list  # of polygons (m, 2)
    colours: np.ndarray  # (k, 3) of these, 0 to 1
    springs: np.ndarray  # (mounts, 10, 2)
    spring_colours: np.ndarray  # (mounts, 3)
    clear: list  # of polygons (m, 2)
    clear_colours: np.ndarray  # (j, 3)


class _Mesh(NamedTuple):
    corners: np.ndarray  # (v, 3)
    faces: list  # of arrays of numbers of corners
    colours: np.ndarray  # (faces, 3), 0 to 1
    clear: np.ndarray  # (faces,)


class Painter:
    """Paints a vehicle (`parameters.Vehicle`), given a `System` of it, from a camera that goes along with it."""

    def __init__(self, vehicle, system, strips):
        names = [body.name for body in build_body_table(vehicle)]
        parts = body_parts(vehicle, system)
        self._bodies = [_mesh(parts[name]) for name in names]
        self._shoe = _mesh(shoe_parts(vehicle)[:1])  # pins would be a few pixels
        self.mounts, self._strips = mount_places(vehicle, names), strips

    def paint(self, pose, load):
        """Return the `Paint` of a `scene.poses.Pose`, the mounts coloured by loads (m,) from 0 to 1."""
        forward = Rotation.from_quat(pose.attitude[0]).as_matrix()[:, 0]
        camera = _Camera(pose.place[0] * (1.0, 1.0, 0.0), np.arctan2(forward[1], forward[0]))
        for mesh, place, turn in zip(self._bodies, pose.place, Rotation.from_quat(pose.attitude), strict=True):
            camera.take(turn.apply(mesh.corners) + place, mesh)
        left = left_axis(pose)
        for side in SIDES:
            for place, turn in zip(*link_poses(pose.pins[side], left), strict=True):
                camera.take(Rotation.from_quat(turn).apply(self._shoe.corners) + place, self._shoe)
        road = self._road(pose.place[0])
        ground = camera.seen(*road) if road is not None else ([], np.zeros((0, 3)))
        solid, colours, clear, clear_colours = camera.sorted()
        springs = self.mounts.springs(pose)
        return Paint(
            ground[0] + solid,
            np.concatenate((ground[1], colours)),
            camera.project(springs.reshape(-1, 3))[0].reshape(*springs.shape[:2], 2),
            of_load(load) / 255.0,
            clear,
            clear_colours,
        )

    def _road(self, place):
        """Corners and faces of the road around a place, the farthest first."""
        if self._strips is None:
            return None
        near = np.hypot(*(self._strips.corners[0, :, :2] - place[:2]).T) < _AROUND + 2.0
        first, *_, last = np.flatnonzero(near) if near.sum() > 1 else (0, 1)
        corners = self._strips.corners[:, first : last + 1]
        colours = self._strips.colours[:, first : last + 1] / 255.0
        m = corners.shape[1]
        k = np.arange(m - 1)
        faces = [np.stack((e * m + k, (e + 1) * m + k, (e + 1) * m + k + 1, e * m + k + 1), -1) for e in (0, 2)]
        return corners.reshape(-1, 3), np.concatenate(faces), np.concatenate([colours[e, :-1] for e in (0, 2)])


class _Camera:
    """Collects faces, and projects them."""

    def __init__(self, place, heading):
        turn = Rotation.from_euler("z", heading)
        self._eye, target = place + turn.apply(_EYE), place + turn.apply(_TARGET)
        ahead = (target - self._eye) / np.linalg.norm(target - self._eye)
        right = np.cross(ahead, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        self._axes, self._focus = np.array([right, np.cross(right, ahead), ahead]), np.linalg.norm(target - self._eye)
        self._solid, self._clear = [], []

    def project(self, places):
        """Return places in the picture (n, 2), and how far (n,) from the camera they are [m]."""
        across, up, depth = self._axes @ (places - self._eye).T
        return self._focus * np.stack((across, up), axis=-1) / depth[:, None], depth

    def take(self, corners, mesh):
        """Take the faces of a mesh whose corners are at places (v, 3) that are turned towards the camera."""
        flat, depth = self.project(corners)
        for face, colour, clear in zip(mesh.faces, mesh.colours, mesh.clear, strict=True):
            a, b, c = corners[face[:3]]
            normal = np.cross(b - a, c - b)
            if normal @ (self._eye - a) <= 0.0:
                continue
            light = _DARKEST + (1.0 - _DARKEST) * max(normal @ _LIGHT, 0.0) / np.linalg.norm(normal)
            (self._clear if clear else self._solid).append((depth[face].mean(), flat[face], light * colour))

    def seen(self, corners, faces, colours):
        """Return polygons and lit colours of the faces of a road."""
        flat, _ = self.project(corners)
        quads = corners[faces]
        normal = np.cross(quads[:, 1] - quads[:, 0], quads[:, 2] - quads[:, 1])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        light = np.clip((normal @ _LIGHT) ** 6 / _LIGHT[2] ** 6, 0.5, 1.2)  # slopes are small
        return list(flat[faces]), np.clip(light[:, None] * colours, 0.0, 1.0)

    def sorted(self):
        """Return solid polygons and their colours, then clear ones and theirs, each the farthest first."""
        out = []
        for faces in (self._solid, self._clear):
            faces.sort(key=lambda each: -each[0])
            out += [[polygon for _, polygon, _ in faces], np.array([colour for *_, colour in faces]).reshape(-1, 3)]
        return out


def _mesh(parts):
    corners, faces, colours, clear, count = [], [], [], [], 0
    for part in parts:
        surfaces = surface(part)
        corners.append(surfaces.corners)
        faces += [np.array(face) + count for face in surfaces.faces]
        colours += [np.array(part.colour) / 255.0] * len(surfaces.faces)
        clear += [part.see_through] * len(surfaces.faces)
        count += len(surfaces.corners)
    return _Mesh(np.concatenate(corners), faces, np.array(colours), np.array(clear))
