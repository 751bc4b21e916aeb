"""Recordings made of arrays, as if they had been read from a bag."""

from collections import Counter
from pathlib import Path

import numpy as np
from mr_mount_controller.mounting import PAIR
from trackvib_sim.bags.recording import Answers, Inertial, LoopCounts, Mounts, Odometry, Recording
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
