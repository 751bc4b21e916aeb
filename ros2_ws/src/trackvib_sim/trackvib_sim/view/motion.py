"""How a recorded vehicle moved: the poses of a run in lock-step by driving it again, else those of its frames."""

from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.topics import VEHICLE_DESCRIPTION

from ..bags.errors import BagError
from ..bags.provenance import parameters_with
from ..console import followed
from ..nodes.simulator_parameters import prepare_again
from ..numerics.units import NANO
from ..scene.poses import PoseReader
from ..scene.road_strips import Way, way_of
from ..simulation.recorded_currents import NotTold, currents_in_force
from ..simulation.simulation import RunFailed
from ..vehicle.drive.path import path_heading
from ..vehicle.vehicle_file import parse_vehicle
from .recorded_poses import read_recorded_poses, way_of_recording

MOST_FRAMES = 10_000


class Span(NamedTuple):
    """What of a run is shown."""

    rate: float = 50.0  # frames a second of simulated time, at most
    start: float = 0.0  # s
    end: float = np.inf  # s


class Motion(NamedTuple):
    """The k frames of a run."""

    time: np.ndarray  # (k,) ns
    poses: list  # of k `scene.poses.Pose`
    way: Way
    note: str  # what is to be said of them, or nothing


def read_motion(recording, span, console):
    """Return the vehicle (`parameters.Vehicle`) of a `bags.recording.Recording`, and its `Motion`.

    Raises
    ------
    BagError, ValueError
        The bag does not tell enough, or holds more frames than are accepted; the message says which.
    """
    recording.require("vehicle")
    vehicle = parse_vehicle(recording.vehicle, VEHICLE_DESCRIPTION)
    first, last = (float(stamp) / NANO for stamp in recording.chassis.stamp[[0, -1]])
    begin, end = max(span.start, first), min(span.end, last)
    if not begin < end:
        raise ValueError(
            f"the bag holds nothing from {span.start:g} to {span.end:g} s: it covers {first:g} to {last:g} s"
        )
    if (end - begin) * span.rate > MOST_FRAMES:
        raise ValueError(
            f"{(end - begin) * span.rate:.0f} frames are asked for, accepted: {MOST_FRAMES}; choose --start, --end "
            "or a lower --rate"
        )
    _, parameters = parameters_with(recording.provenance, "physics_rate")
    span = Span(span.rate, begin, end)
    if parameters.get("pace") == "realtime":
        time, poses = read_recorded_poses(recording, vehicle, span)
        return vehicle, Motion(time, poses, way_of_recording(recording), "")
    return vehicle, _driven_again(recording, vehicle, span, console)


def _driven_again(recording, vehicle, span, console):
    """Drive a run in lock-step again: the same bits, on the machine that it was recorded on."""
    recording.require("mounts", "road")
    simulation, values = prepare_again(recording)
    mounts = simulation.mounting
    if (mounts.coils, len(mounts.mounts)) != (recording.mounting.coils, len(recording.mounting.mounts)):
        raise BagError("the mounts described in the bag are not those of its vehicle")
    rates, reader = simulation.settings.rates, PoseReader(vehicle, simulation.system)
    every = max(1, round(rates.control / span.rate))
    frames, note = [], ""
    currents = currents_in_force(simulation, recording, values["on_silence"])
    for _ in followed(range(int(span.end * NANO) // rates.period), "repeating the run", console):
        try:
            demanded = next(currents)
            if not simulation.road_is_enough():
                break
            simulation.advance(demanded)
        except (NotTold, RunFailed):
            break
        if simulation.periods % every == 0 and simulation.time >= span.start * NANO:
            path, place = simulation.state.drive.path, simulation.state.tree.position[0, :2].copy()
            on_path = float(path.distance[0]), float(path.offset[0]), *place, path_heading(path)[0]
            frames.append((simulation.time, reader.read(simulation.state), on_path))
            note = note or _difference(recording, simulation)
    if not frames:
        raise ValueError(f"the bag does not hold enough to repeat its run from {span.start:g} s on")
    time, poses, on_path = zip(*frames, strict=True)
    distance, offset, x, y, heading = np.array(on_path).T
    way = way_of(distance, offset, np.stack((x, y), axis=-1), heading)
    return Motion(np.array(time), list(poses), way, note)


def _difference(recording, simulation):
    """Say when the forces of the mounts first are not those of the bag."""
    row = np.searchsorted(recording.mounts.stamp, simulation.time)
    if row == len(recording.mounts.stamp) or recording.mounts.stamp[row] != simulation.time:
        return ""
    if np.array_equal(recording.mounts.force[row], simulation.sample.mounts.force):
        return ""
    return f"from t = {simulation.time / NANO:.3f} s on the samples are not those recorded: another machine or version"
