"""What a bag tells of a run, as columns of numbers."""

from collections import Counter
from collections.abc import Collection
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from mr_mount_controller.mounting import Mounting
from mr_mount_controller.node_base import topics

from ..numerics.units import NANO
from .errors import BagError

_TOPIC_OF = {"mounts": topics.MOUNT_STATE, "road": topics.ROAD_PROFILE, "vehicle": topics.VEHICLE_DESCRIPTION}


class Inertial(NamedTuple):
    """One sensor over a run."""

    stamp: np.ndarray  # (k,) ns
    specific_force: np.ndarray  # (k, 3) m/s^2
    angular_velocity: np.ndarray | None = None  # (k, 3) rad/s, where it was measured
    logged: np.ndarray | None = None  # (k,) when each message was recorded, ns
    covariance: np.ndarray | None = None  # (k,) first number of that of the force; -1: not measured
    orientation: np.ndarray | None = None  # (k, 4) x y z w of the sensor in a world with z up, where it is asked for
    orientation_covariance: np.ndarray | None = None  # (k,) first number, likewise

    def at(self, index):
        """Return the samples with some index, in its order."""
        return Inertial(*(None if column is None else np.asarray(column)[index] for column in self))


class Mounts(NamedTuple):
    """All n mounts over a run, those with a coil first; vectors in the hull's axes, as `MountState` has them."""

    stamp: np.ndarray  # (k,) ns
    current: np.ndarray  # (k, coils) in the coil, A
    stiffness: np.ndarray  # (k, n) N/m
    damping: np.ndarray  # (k, n) N s/m
    deflection: np.ndarray  # (k, n, 3) from the unloaded place, m
    velocity: np.ndarray  # (k, n, 3) m/s
    force: np.ndarray  # (k, n, 3) on the powertrain, N
    dissipated_power: np.ndarray  # (k, n) W


class Answers(NamedTuple):
    """What the controller asked for, in the order of arrival."""

    sample_stamp: np.ndarray  # (m,) stamp of the sample that each current answers, ns
    current: np.ndarray  # (m, coils) demanded, A


class Odometry(NamedTuple):
    """Where the hull was."""

    stamp: np.ndarray  # (k,) ns
    position: np.ndarray  # (k, 3) m
    speed: np.ndarray  # (k,) forward, in the hull's axes, m/s


class Drive(NamedTuple):
    """How the vehicle was driven, as `DriveState` has it."""

    stamp: np.ndarray  # (k,) ns
    distance: np.ndarray  # (k,) along the path, m
    offset: np.ndarray  # (k,) from it to the left, m
    wanted_speed: np.ndarray  # (k,) m/s
    curvature: np.ndarray  # (k,) of the path, to the left, 1/m
    engine_speed: np.ndarray  # (k,) r/min
    gear: np.ndarray  # (k,) 0 where the engine turned at a speed of its own
    sprocket_speed: np.ndarray  # (k, 2) left, right, rad/s
    sprocket_torque: np.ndarray  # (k, 2) N m


class Commands(NamedTuple):
    """What the simulator was told on `cmd_vel`, in the order in which it took it."""

    stamp: np.ndarray  # (c,) simulated time from which on it was in force, ns
    speed: np.ndarray  # (c,) m/s
    yaw_rate: np.ndarray  # (c,) rad/s


class LoopCounts(NamedTuple):
    """What the simulator counted in its loop, in the order of its time."""

    stamp: np.ndarray  # (d,) ns
    silent_periods: np.ndarray  # (d,) up to then
    answers: np.ndarray  # (d,) to samples that were out, up to then


class Recording(NamedTuple):
    """The contents of a bag; optional topics that are not in the bag are None.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> tv.read_recording(bag).mounts.force.shape[1:]  # mounts, x y z
    (2, 3)
    """

    path: Path
    topics: dict  # end of a topic's name -> whole name
    chassis: Inertial
    powertrain: Inertial
    sensors: dict  # further ones: name -> `Inertial`
    mounting: Mounting  # what the mounts are called; of a bag that does not tell as `mounting.undescribed` does
    mounts: Mounts | None
    answers: Answers | None
    odometry: Odometry | None
    drive: Drive | None
    commands: Commands | None
    road: Collection  # of patches (start, spacing, left, right), m
    vehicle: str | None  # text of the vehicle file
    drive_file: str | None  # text of the drive file, empty where there was none
    loop_counts: LoopCounts
    diagnostics: dict  # last values of the simulator, as text
    provenance: dict  # metadata records of the bag: name -> dict of text
    counts: Counter  # messages a topic
    complete: bool  # False where the bag was cut short
    notes: tuple = ()  # sentences: what of the bag was left out, and what was done to it
    origins: dict = MappingProxyType({})  # sensor -> `sources.Origin`, of those that are there
    transforms: dict = MappingProxyType({})  # frame -> frame above it and quaternion in it, as /tf_static tells
    own: dict = MappingProxyType({})  # sensor -> `Inertial` at its own rate, where it was resampled to the other one's
    law_changes: tuple = ()  # of the law's parameters: last stamp [ns] before it, and new values by name
    clocks: dict | None = None  # end of topic -> `analysis.stamp_numbers.Clock`, once sensors are on one time base

    @property
    def streams(self):
        """What was measured, asked for and odometry: end of a topic's name -> columns, the stamps first."""
        parts = {
            topics.CHASSIS_IMU: self.chassis,
            topics.POWERTRAIN_IMU: self.powertrain,
            topics.MOUNT_STATE: self.mounts,
            topics.COIL_CURRENT: self.answers,
            topics.ODOMETRY: self.odometry,
            topics.DRIVE_STATE: self.drive,
            **{topics.imu_topic(name): sensor for name, sensor in self.sensors.items()},
        }
        return {end: columns for end, columns in parts.items() if columns is not None}

    def require(self, *parts):
        """Make sure that this is one run with both sensors and some optional parts: "mounts", "road", "vehicle".

        Raises
        ------
        BagError
            A part is missing, or stamps go back.
        """
        absent = [sensor for sensor in ("chassis", "powertrain") if self.origins and sensor not in self.origins]
        missing = [*map(topics.imu_topic, absent), *(_TOPIC_OF[part] for part in parts if not getattr(self, part))]
        if missing:
            raise BagError(f"bag {str(self.path)!r} holds no messages on {', '.join(missing)}")
        for end, stream in self.streams.items():
            back = np.flatnonzero(np.diff(stream[0]) <= 0) if isinstance(stream, (Inertial, Mounts)) else ()
            if len(back):
                after = f"after t = {stream.stamp[back[0]] / NANO:.3f} s {self.topics[end]} starts again"
                raise BagError(f"bag {str(self.path)!r} holds more than one run: {after}")
