"""Sensors in the vehicle's axes: turned as they sit, and without gravity where their orientation tells it."""

from dataclasses import replace
from tempfile import TemporaryFile

import numpy as np
from mr_mount_controller.node_base.topics import HULL_FRAME

from ..bags.sources import BY_ORIENTATION
from ..bags.transforms import angles_of, rotation_below, rotation_by_angles, rotation_of
from .measured import NOT_MEASURED, STANDARD_GRAVITY
from .numbers import SENSORS
from .stamps import BLOCK, blocks


def in_vehicle_axes(recording, sources):
    """Return a `bags.recording.Recording` in m/s² with its sensors turned as `bags.sources.Sources` tell, or the bag.

    A rotation that the user tells goes before one by the bag's static transforms; without either nothing is turned.

    Raises
    ------
    ValueError
        A rotation is of a sensor that is not there, or a sensor gives no orientation to remove gravity by.
    """
    unknown = sources.rotations.keys() - recording.origins.keys() - {""}
    if unknown:
        raise ValueError(f"a rotation of {', '.join(sorted(unknown))}, the sensors are {', '.join(recording.origins)}")
    pair = {sensor: getattr(recording, sensor) for sensor in SENSORS}
    placed, origins = {**pair, **recording.sensors}, dict(recording.origins)
    for name, origin in recording.origins.items():
        inertial, upright = placed[name], sources.gravity == BY_ORIENTATION
        rotation, teller = _rotation(recording, origin, sources.angles(name))
        if upright:
            _require_orientation(name, inertial)
        if upright or teller:
            placed[name] = _placed(inertial, rotation, upright)
        told = sources.angles(name) if teller == "--rotate" else angles_of(rotation)
        origins[name] = replace(origin, rotation=tuple(told), rotation_by=teller, gravity=sources.gravity)
    pair = {sensor: placed.pop(sensor) for sensor in SENSORS}
    return recording._replace(**pair, sensors=placed, origins=origins)


def _rotation(recording, origin, angles):
    """Return the rotation (3, 3) of a sensor in the vehicle, and who told it."""
    if angles is not None:
        return rotation_by_angles(angles), "--rotate"
    found = rotation_below(recording.transforms, origin.frame, HULL_FRAME) if origin.frame else None
    return (np.eye(3), "") if found is None else (found, "/tf_static")


def _require_orientation(name, inertial):
    if inertial.orientation is None or (inertial.orientation_covariance[:] == NOT_MEASURED).any():
        raise ValueError(f"{name} has no orientation for removing gravity; `--gravity mean` needs none")


def _placed(inertial, rotation, upright):
    """Return an `Inertial` in the vehicle's axes, with `upright` without gravity, in a temporary file."""
    shape = inertial.specific_force.shape
    force = np.memmap(TemporaryFile(), float, shape=shape)  # lives as long as the array  # noqa: SIM115
    for block in blocks(shape[0], BLOCK):
        within = np.array(inertial.specific_force[block])
        if upright:
            attitude = rotation_of(np.array(inertial.orientation[block]))
            if attitude is None:
                raise ValueError("an orientation is not a rotation; `--gravity mean` needs none")
            within -= STANDARD_GRAVITY * attitude[:, 2]  # the third row: up, as the sensor sees it
        force[block] = within @ rotation.T
    return inertial._replace(specific_force=force)


def origin_words(origin):
    """Return in words where a sensor's samples come from and what was done to them."""
    words = [f"{origin.source} ({origin.type_name.rsplit('/', 1)[-1]})"]
    if origin.rotation_by:
        angles = ", ".join(f"{angle:.4g}" for angle in origin.rotation)
        words.append(f"turned from roll, pitch, yaw {angles} degrees ({origin.rotation_by})")
    if origin.gravity == BY_ORIENTATION:
        words.append("gravity removed by orientation")
    return "; ".join(words)
