"""`trackvib replay --verify`: the simulator on the recorded road and currents, set beside its recorded sensors."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base import topics

from ..analysis.numbers import AXES
from ..bags.known_topics import COLUMNS
from ..bags.reading import read_recording
from ..bags.versions import versions
from ..console import followed
from ..nodes.simulator_parameters import prepare_again
from ..numerics.units import NANO
from ..simulation.readings import Readings
from ..simulation.recorded_currents import NotTold, currents_in_force
from ..simulation.simulation import RunFailed

_TAIL = NANO  # ns at the end of a bag in which its topics need not end together


class NotVerifiable(ValueError):
    """A bag that does not tell enough; the message says what is missing."""


class Difference(NamedTuple):
    """The first number that did not come out again."""

    stamp: int  # ns
    topic: str
    channel: str
    recorded: float
    replayed: float

    def __str__(self):
        size = abs(self.replayed - self.recorded)
        return (
            f"at t = {self.stamp / NANO:.3f} s {self.channel} of {self.topic} is {self.recorded!r} in the bag and "
            f"{self.replayed!r} replayed, {size:.3g} apart"
        )


def verify(bag, console):
    """Drive a recorded run again; returns whether it came out bit-identical, and that in one line.

    Raises
    ------
    BagError
        The bag cannot be read.
    ValueError
        It does not tell enough; the message says what is missing.
    """
    recording = read_recording(bag)
    recording.require("mounts", "road", "vehicle")
    simulation, values = prepare_again(recording)
    if values["pace"] != "lockstep":
        raise NotVerifiable(
            "its run followed the wall clock (pace is 'realtime'), so its results depend on the machine"
        )
    _require_same_mounts(recording.mounting, simulation.mounting)
    mounts = _Stream(recording, topics.MOUNT_STATE, simulation.mounting.names)
    names = [sensor.name for sensor in simulation.sensors]
    recorded = [name for name in names if topics.imu_topic(name) in recording.streams]
    sensors = {name: _Stream(recording, topics.imu_topic(name)) for name in recorded}
    # the mounts first: a wrong current is seen there by its name
    streams, readings = (mounts, *sensors.values()), Readings(simulation)
    rates, last = simulation.settings.rates, int(max(stream.stamp[-1] for stream in streams))
    answered = last if recording.answers is None else recording.answers.sample_stamp.max()
    for stream in streams:
        odd = stream.stamp[(stream.stamp % rates.period != 0) | (stream.stamp <= 0)]
        if odd.size:
            raise NotVerifiable(f"{stream.topic} has the stamp {odd[0]} ns, which is not the end of a period")
    currents = currents_in_force(simulation, recording, values["on_silence"])
    other = _other_versions(recording.provenance)
    for _ in followed(range(last // rates.period), "repeating the run", console):
        try:
            demanded = next(currents)
        except NotTold as gap:
            if simulation.time > answered and last - simulation.time < _TAIL:
                break
            raise NotVerifiable(_after(simulation, streams, str(gap))) from None
        if not simulation.road_is_enough():
            raise NotVerifiable(_after(simulation, streams, f"no road is recorded at {simulation.distance:.1f} m"))
        try:
            simulation.advance(demanded)
        except RunFailed as failure:
            return False, f"different: replayed, {failure}; the recorded run continues{other}"
        time, sample = simulation.time, simulation.sample
        difference = mounts.difference(time, sample.mounts)
        for name, reading in readings.take().items():
            if name in sensors:
                difference = difference or sensors[name].difference(time, reading)
        if difference:
            return False, f"different: {difference}{other}"
    if not all(stream.compared for stream in streams):
        raise NotVerifiable(f"its samples begin after t = {simulation.time / NANO:.3f} s, where its answers end")
    count = ", ".join(f"{stream.compared} of {stream.topic}" for stream in streams)
    cut = "" if recording.complete else "; the bag was cut short and contains no more"
    return True, f"identical to the last bit: {count}, up to t = {simulation.time / NANO:.3f} s{cut}{other}"


class _Stream:
    """A recorded topic beside which samples are set, one after the other."""

    def __init__(self, recording, end, mounts=()):
        """Take the end of the topic's name, and what the mounts are called if it is theirs."""
        self.topic, self.compared, self._mounts = recording.topics[end], 0, mounts
        fields = COLUMNS.get(end, COLUMNS[topics.CHASSIS_IMU]).fields
        self._fields = [field for field, _ in list(fields.values())[1:]]
        self.stamp, *self._columns = map(np.asarray, recording.streams[end][: len(fields)])

    def difference(self, time, values):
        """Set the sample of a time [ns] beside the recorded one; returns the first `Difference` of its bits, if any."""
        place = self.compared
        if place == len(self.stamp) or self.stamp[place] != time:
            return None  # not in the bag
        self.compared += 1
        for field, column, replayed in zip(self._fields, self._columns, values, strict=True):
            recorded = column[place]
            if recorded.tobytes() != replayed.tobytes():
                where = tuple(np.argwhere(recorded.view(np.uint64) != replayed.view(np.uint64))[0])
                places = (self._mounts, AXES) if self._mounts else (AXES,)
                channel = ".".join((field, *(names[index] for names, index in zip(places, where, strict=False))))
                return Difference(time, self.topic, channel, float(recorded[where]), float(replayed[where]))
        return None


def _require_same_mounts(recorded, simulated):
    there, here = ((mounting.coils, len(mounting.mounts)) for mounting in (recorded, simulated))
    if there != here:
        raise NotVerifiable("it describes {} coils and {} mounts, its vehicle has {} and {}".format(*there, *here))


def _after(simulation, streams, reason):
    if not any(stream.compared for stream in streams):
        return reason
    return f"{reason}; up to t = {simulation.time / NANO:.3f} s it is identical to the last bit"


def _other_versions(provenance):
    """Return in words with which other versions a bag was made, or nothing."""
    made = provenance.get("versions", {})
    other = [f"{name} {made[name]} (here {here})" for name, here in versions().items() if made.get(name, here) != here]
    return f"; the bag was made with {', '.join(other)}" if other else ""


def run_replay_verify(bag, console):
    """Print the verdict on a bag; returns the exit code: 0 identical, 1 different. Raises as `verify` does."""
    identical, words = verify(bag, console)
    console.print(f"{Path(bag).name}: {words}", soft_wrap=True)
    return 0 if identical else 1
