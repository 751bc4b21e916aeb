"""Inertial sensors: where they are and how they are turned. Chassis and powertrain have one in every vehicle."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from .body_tree import bodies_on_hinges
from .mounts import mounts_in_order
from .parameters import CHASSIS, POWERTRAIN


class Instrument(NamedTuple):
    """Errors of three axes of a sensor, in the unit of the measured quantity.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Instrument(noise=0.002).is_ideal
    False
    """

    noise: float = 0.0  # one-sided density, unit / sqrt(Hz)
    bias: tuple = (0.0, 0.0, 0.0)
    range: float = np.inf  # to either side
    resolution: float = 0.0  # 0 for none

    @property
    def is_ideal(self) -> bool:
        """Whether there are no errors."""
        return self == _IDEAL


_IDEAL = Instrument()


class Sensor(NamedTuple):
    """An inertial sensor.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Sensor("cupola", "turret", (0.0, 0.0, 0.5)).divisor
    1
    """

    name: str
    body: str  # name in the body table
    place: tuple  # in the body's axes, from its origin, m
    turn: np.ndarray = np.eye(3)  # (3, 3) from the sensor's axes into those of the body
    divisor: int = 1  # control periods that make one of its samples
    bandwidth: float | None = None  # Hz, of its analogue low-pass; None for that of its sampling rate
    accelerometer: Instrument = Instrument()
    gyroscope: Instrument = Instrument()


def sensors_of(vehicle):
    """Return the `Sensor`s of a vehicle: chassis and powertrain first, then the others in the file's order.

    Where the file does not tell, these two are at the ends of the powertrain's mounts, in the middle between those
    with coils, or between all if none has one.
    """
    listed = {name: _sensor(name, section) for name, section in vehicle.sensors.items()}
    between = [sensor for sensor in _between_mounts(vehicle) if sensor.name not in listed]
    first = {sensor.name: sensor for sensor in between} | listed
    return [first.pop(CHASSIS), first.pop(POWERTRAIN), *first.values()]


def _sensor(name, section):
    turn = Rotation.from_euler("xyz", section.orientation or (0.0, 0.0, 0.0), degrees=True).as_matrix()
    divisor, instruments = int(section.divisor or 1), (_instrument(section, prefix) for prefix in ("", "rate_"))
    return Sensor(name, section.body, tuple(section.place), turn, divisor, section.bandwidth, *instruments)


def _instrument(section, prefix):
    given = {name: getattr(section, prefix + name) for name in Instrument._fields}
    return Instrument(
        **{
            name: tuple(value) if isinstance(value, list) else value
            for name, value in given.items()
            if value is not None
        }
    )


def _between_mounts(vehicle):
    mounts = [mount for _, mount in mounts_in_order(vehicle) if mount.body == POWERTRAIN]
    if not mounts:
        return []
    coils = [mount for mount in mounts if vehicle.mount_types[mount.type].kind == "mr"]
    upper = np.array([mount.place for mount in coils or mounts])
    powertrain = bodies_on_hinges(vehicle)[POWERTRAIN]
    lower = upper + np.array(powertrain.place)
    parent = Sensor(CHASSIS, powertrain.parent, tuple(lower.mean(0).tolist()))
    return [parent, Sensor(POWERTRAIN, POWERTRAIN, tuple(upper.mean(0).tolist()))]
