"""The moving vehicle, its tracks, mounts, sensors and road as entities of Rerun."""

import numpy as np
import rerun as rr
from scipy.spatial.transform import Rotation

from ..scene.bodies import body_parts, shoe_parts
from ..scene.colours import OTHER_SENSOR, SENSORS, of_load
from ..scene.mounts import mount_places, sensor_places
from ..scene.poses import left_axis, link_poses
from ..scene.shapes import surface
from ..vehicle.body_tree import SIDE_NAMES, build_body_table

WORLD, FOLLOW = "world", "world/follow"
TIMELINE = "time"
_ARROW = 0.06  # m a m/s^2
_CLEAR = 90  # of 255, opacity of what encloses others
GRAVITY_UP = np.array([0.0, 0.0, 9.81])


class VehicleLog:
    """Writes one vehicle to a `rerun.RecordingStream`: first `begin`, then any number of `frames`."""

    def __init__(self, stream, vehicle, system):
        self._stream, self._vehicle, self._system = stream, vehicle, system
        self.names = [body.name for body in build_body_table(vehicle)]
        self.mounts, self.sensors = mount_places(vehicle, self.names), sensor_places(vehicle)

    def begin(self):
        """Write what never changes: shapes and marks."""
        log = self._stream.log
        log(WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        for name, parts in body_parts(self._vehicle, self._system).items():
            solid = [part for part in parts if not part.see_through]
            if solid:
                log(f"{WORLD}/{name}/shape", mesh(solid), static=True)
            for part in parts:
                if part.see_through:
                    log(f"{WORLD}/{name}/box", _box(part), static=True)
        for name in SIDE_NAMES.values():
            log(f"{WORLD}/{name}_track", mesh(shoe_parts(self._vehicle)), static=True)
        for sensor in self.sensors:
            path, colour = self._path(sensor), SENSORS.get(sensor.name, OTHER_SENSOR)
            there = rr.Transform3D(translation=sensor.place, quaternion=rr.Quaternion(xyzw=sensor.attitude))
            log(path, there, static=True)
            mark = rr.Boxes3D(half_sizes=[(0.05, 0.05, 0.03)], colors=[colour], fill_mode="solid")
            log(f"{path}/mark", mark, static=True)

    def frames(self, time, poses):
        """Write where everything is at times (k,) [ns] in k poses."""
        place, attitude = (np.stack([getattr(pose, name) for pose in poses]) for name in ("place", "attitude"))
        for row, name in enumerate(self.names):
            columns = rr.Transform3D.columns(translation=place[:, row], quaternion=attitude[:, row])
            self._send(f"{WORLD}/{name}", time, columns)
        for side, name in SIDE_NAMES.items():
            links = [link_poses(pose.pins[side], left_axis(pose)) for pose in poses]
            middles, turns = (np.concatenate(each) for each in zip(*links, strict=True))
            columns = rr.InstancePoses3D.columns(translations=middles, quaternions=turns)
            self._send(f"{WORLD}/{name}_track", time, columns.partition([len(each) for each, _ in links]))
        # the camera goes along with the hull, level with the road
        forward = Rotation.from_quat(attitude[:, 0]).as_matrix()[:, :, 0]
        heading = np.arctan2(forward[:, 1], forward[:, 0])
        turn = Rotation.from_euler("z", heading[:, None]).as_quat()
        ground = place[:, 0] * (1.0, 1.0, 0.0)
        self._send(FOLLOW, time, rr.Transform3D.columns(translation=ground, quaternion=turn))

    def mount_frames(self, time, poses, current, force):
        """Write the mounts as springs, coloured by current (k, coils) [A], or by the size of the force (k, m) [N]."""
        m = len(self.mounts.names)
        if not m:
            return
        share = np.abs(force) / max(float(np.abs(force).max()), 1.0)
        share[:, : self.mounts.coils] = current / self.mounts.highest
        springs = np.concatenate([self.mounts.springs(pose) for pose in poses])
        colours = of_load(share).reshape(-1, 3)
        columns = rr.LineStrips3D.columns(strips=springs, colors=colours, radii=np.full(len(springs), 0.012))
        self._send(f"{WORLD}/mounts", time, columns.partition([m] * len(poses)))

    def sensor_frames(self, name, time, specific_force):
        """Write the acceleration of a sensor, specific force (k, 3) [m/s^2] without gravity, as an arrow."""
        sensor = next(each for each in self.sensors if each.name == name)
        vectors = _ARROW * (specific_force - Rotation.from_quat(sensor.attitude).inv().apply(GRAVITY_UP))
        colour = np.tile(SENSORS.get(name, OTHER_SENSOR), (len(vectors), 1)).astype(np.uint8)
        columns = rr.Arrows3D.columns(vectors=vectors, colors=colour, radii=np.full(len(vectors), 0.02))
        self._send(f"{self._path(sensor)}/acceleration", time, columns)

    def road(self, strips):
        """Write the road, the `scene.road_strips.Strips` of it."""
        corners = strips.corners.reshape(-1, 3)
        drawn = rr.Mesh3D(
            vertex_positions=corners,
            triangle_indices=strips.triangles,
            vertex_normals=_normals(corners, strips.triangles),
            vertex_colors=strips.colours.reshape(-1, 3),
        )
        self._stream.log(f"{WORLD}/road", drawn, static=True)

    def road_now(self, time, corners, colours):
        """Write the road around the vehicle at a time [ns]: corners (3 t, 3) [m] of triangles, with their colours."""
        triangles = np.arange(len(corners)).reshape(-1, 3)
        self._stream.set_time(TIMELINE, duration=np.timedelta64(time, "ns"))
        normals = _normals(corners, triangles)
        drawn = rr.Mesh3D(
            vertex_positions=corners, triangle_indices=triangles, vertex_normals=normals, vertex_colors=colours
        )
        self._stream.log(f"{WORLD}/road", drawn)
        self._stream.reset_time()

    def _path(self, sensor):
        return f"{WORLD}/{sensor.body}/{sensor.name}_imu"

    def _send(self, path, time, columns):
        send_columns(self._stream, path, time, columns)


def send_columns(stream, path, time, columns):
    """Write columns of k rows at times (k,) [ns]."""
    duration = np.asarray(time).astype("timedelta64[ns]")
    rr.send_columns(path, [rr.TimeColumn(TIMELINE, duration=duration)], columns, recording=stream)


def mesh(parts):
    """Return the `rerun.Mesh3D` of `Part`s: faces are flat, so that each has its own corners."""
    positions, normals, colours, triangles, count = [], [], [], [], 0
    for part in parts:
        corners = surface(part)
        faces = corners.corners[corners.triangles]
        normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        positions.append(faces.reshape(-1, 3))
        normals.append(np.repeat(normal, 3, axis=0))
        colours.append(np.tile(np.array(part.colour, np.uint8), (3 * len(faces), 1)))
        triangles.append(count + np.arange(3 * len(faces)).reshape(-1, 3))
        count += 3 * len(faces)
    return rr.Mesh3D(
        vertex_positions=np.concatenate(positions),
        vertex_normals=np.concatenate(normals),
        vertex_colors=np.concatenate(colours),
        triangle_indices=np.concatenate(triangles),
    )


def _box(part):
    return rr.Boxes3D(
        half_sizes=[0.5 * np.array(part.shape.sides)],
        centers=[part.place],
        colors=[(*part.colour, _CLEAR)],
        fill_mode=rr.components.FillMode.TransparentFillMajorWireframe,
    )


def _normals(corners, triangles):
    """Normals of a surface that bends: those of the faces around each corner, added up."""
    faces = corners[triangles]
    normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    total = np.zeros_like(corners)
    for corner in triangles.T:
        np.add.at(total, corner, normal)
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)
