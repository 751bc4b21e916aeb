"""Recordings made of arrays, as if they had been read from a bag."""

from collections import Counter
from pathlib import Path

import numpy as np
from mr_mount_controller.mounting import PAIR
from trackvib_sim.bags.recording import Answers, Drive, Inertial, LoopCounts, Mounts, Odometry, Recording
from trackvib_sim.data import find_vehicle

MS = 1_000_000  # ns


def made_recording(milliseconds, chassis=None, powertrain=None, speed=10.0):
    """Return a whole recording with samples at some milliseconds (k,), of noise or of specific forces (k, 3)."""
    count, random = len(milliseconds), np.random.default_rng(11)
    stamp = np.asarray(milliseconds) * MS
    chassis = random.normal(size=(count, 3)) if chassis is None else chassis
    powertrain = 0.5 * chassis if powertrain is None else powertrain
    pair, vectors = np.ones((count, 2)), np.zeros((count, 2, 3))
    slow = np.arange(0, milliseconds[-1] + 1, 10) * MS
    return Recording(
        path=Path("bag"),
        topics={end: f"/ns/{end}" for end in ("chassis/imu", "powertrain/imu", "mount_state")},
        chassis=Inertial(stamp, chassis, np.zeros((count, 3))),
        powertrain=Inertial(stamp, powertrain, np.zeros((count, 3))),
        sensors={},
        mounting=PAIR,
        mounts=Mounts(stamp, pair, 1e6 * pair, 1e3 * pair, vectors, vectors, vectors, 5.0 * pair),
        answers=Answers(stamp, 2.0 * pair),
        odometry=Odometry(slow, np.zeros((len(slow), 3)), np.full(len(slow), speed)),
        drive=None,
        commands=None,
        drive_file=None,
        road=[],
        loop_counts=LoopCounts(*np.zeros((3, 0), np.int64)),
        diagnostics={"late": "0"},
        provenance={
            "parameters of /ns/simulator": {"speed": str(speed), "engine_speed": "1650.0"},
            "parameters of /ns/road_excitation": {"level_until": "8.0", "fade": "8.0"},
        },
        counts=Counter({"/chassis/imu": count}),
        vehicle=find_vehicle().read_text(encoding="utf-8"),
        complete=True,
    )


def driven(recording, speed, engine_speed, gear=None):
    """Return a recording with a drive, at the stamps of its odometry after the first.

    Parameters
    ----------
    recording : Recording
    speed, engine_speed : callable
        Of the time (k,) [s], m/s and r/min.
    gear : callable, optional
        Likewise; by default the first one all the time.
    """
    stamp = recording.odometry.stamp
    time = stamp / 1e9
    speeds = speed(time)
    distance = np.append(0.0, np.cumsum(0.5 * (speeds[1:] + speeds[:-1]) * np.diff(time)))
    nothing, pair = np.zeros(len(time)), np.zeros((len(time), 2))
    gears = np.ones(len(time)) if gear is None else gear(time)
    drive = Drive(stamp, distance, nothing, speeds, nothing, engine_speed(time), gears, pair, pair)
    return recording._replace(
        odometry=recording.odometry._replace(speed=speeds),
        drive=Drive(*(column[1:] for column in drive)),
    )
