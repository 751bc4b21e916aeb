"""`trackvib replay --verify`: the simulator on the recorded road and currents, set beside its recorded sensors."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.progress import track

from ..bags.replaying import read_recorded_drive
from ..bags.versions import versions
from ..nodes.simulator_parameters import prepare_again
from ..simulation.recorded_currents import NotTold, currents_in_force
from ..simulation.settings import NANO
from ..simulation.simulation import CHASSIS, POWERTRAIN, RunFailed

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
    recording = read_recorded_drive(bag)
    simulation, values = prepare_again(recording)
    if values["pace"] != "lockstep":
        raise NotVerifiable("its run followed the wall clock (pace is 'realtime'), so it depends on the machine")
    # the mounts first: a wrong current is seen there by its name
    streams = (recording.mounts, recording.chassis, recording.powertrain)
    rates, last = simulation.settings.rates, int(max(stream.stamp[-1] for stream in streams))
    for stream in streams:
        odd = stream.stamp[stream.stamp % rates.period != 0]
        if odd.size:
            raise NotVerifiable(f"{stream.topic} has the stamp {odd[0]} ns, no multiple of the period")
    currents = currents_in_force(simulation, recording, values["on_silence"])
    compared = [0, 0, 0]
    other = _other_versions(recording.provenance)
    for _ in track(range(last // rates.period), "driving again", console=console, transient=True):
        try:
            demanded = next(currents)
        except NotTold as gap:
            if simulation.time > recording.answered.max(initial=0) and last - simulation.time < _TAIL:
                break
            raise NotVerifiable(_after(simulation, compared, str(gap))) from None
        if not simulation.road_is_enough():
            raise NotVerifiable(_after(simulation, compared, f"no road is recorded at {simulation.distance:.1f} m"))
        try:
            simulation.advance(demanded)
        except RunFailed as failure:
            return False, f"different: replayed, {failure}; the recorded run goes on{other}"
        difference = _compare(simulation, streams, compared)
        if difference:
            return False, f"different: {difference}{other}"
    count = ", ".join(f"{n} of {stream.topic}" for n, stream in zip(compared, streams, strict=True))
    cut = "" if recording.complete else "; the bag is cut short, this is what it holds"
    return True, f"identical to the last bit: {count}, up to t = {simulation.time / NANO:.3f} s{cut}{other}"


def _compare(simulation, streams, compared):
    """Set the sample at hand beside the recorded one; returns the first `Difference`, and counts what was compared."""
    sample = simulation.sample
    rows = (
        np.concatenate([np.ravel(part) for part in sample.mounts]),
        np.concatenate((sample.specific_force[CHASSIS], sample.rate[CHASSIS])),
        np.concatenate((sample.specific_force[POWERTRAIN], sample.rate[POWERTRAIN])),
    )
    for number, (stream, row) in enumerate(zip(streams, rows, strict=True)):
        place = compared[number]
        if place == len(stream.stamp) or stream.stamp[place] != simulation.time:
            continue  # not in the bag
        compared[number] += 1
        recorded = stream.values[place]
        if recorded.tobytes() != row.tobytes():
            bits = recorded.view(np.uint64) != row.view(np.uint64)
            column = int(np.argmax(bits))
            channel = stream.channels[column]
            return Difference(simulation.time, stream.topic, channel, float(recorded[column]), float(row[column]))
    return None


def _after(simulation, compared, reason):
    if not any(compared):
        return reason
    return f"{reason}; up to t = {simulation.time / NANO:.3f} s it is identical to the last bit"


def _other_versions(provenance):
    """Return in words with which other versions a bag was made, or nothing."""
    made = provenance.get("versions", {})
    other = [f"{name} {made[name]} (here {here})" for name, here in versions().items() if made.get(name, here) != here]
    return f"; the bag was made with {', '.join(other)}" if other else ""


def perform(bag, console):
    """Print the verdict on a bag; returns the exit code: 0 identical, 1 different. Raises as `verify` does."""
    identical, words = verify(bag, console)
    console.print(f"{Path(bag).name}: {words}", soft_wrap=True)
    return 0 if identical else 1
