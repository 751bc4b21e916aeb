"""From a recording to its `Analysis`: a table of contents."""

from collections.abc import Callable
from math import hypot

import numpy as np

from ..bags.recording import Recording
from ..numerics.units import NANO
from .acceleration_numbers import measure_accelerations
from .history import build_history
from .levels import build_bins
from .lines import find_lines
from .loop_health import drive, loop_health, mount_energy
from .mount_numbers import currents, moments, mount_numbers
from .notes import find_notes
from .numbers import Analysis
from .segments import find_segments
from .vibration import band


def analyse(
    recording: Recording,
    settle: float | None = None,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
) -> Analysis:
    """Return the `Analysis` of a `bags.recording.Recording`.

    Parameters
    ----------
    recording : Recording
    settle : float, optional
        Time from the start that does not count, `SHORTEST_SETTLING` or more, s; by default `settling_of`.
    on_progress : callable
        Is told now and then how many samples of how many have been looked at.

    Raises
    ------
    TooShort
        No segment without gaps leaves a second to be measured.
    ValueError
        The settling time is too short, the sensors differ in their rates, or their stamps cannot be a time base.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> analysis = tv.analyse(tv.read_recording(bag))
    >>> bool(analysis.sensors["powertrain"]["z"].rms > 0.0)  # m/s^2, 0.5 Hz and above
    True
    """
    segments = find_segments(recording, settle)
    loop = loop_health(recording)
    bins = build_bins(segments.begin, segments.last)
    sensors, spectra, levels = measure_accelerations(recording, segments, bins, on_progress)
    speed, speed_deviation = _speed(recording.odometry, segments.settled)
    engine_speed, lines, why_fewer = find_lines(recording, spectra, speed, speed_deviation)
    mounts, answers, energy = recording.mounts, recording.answers, mount_energy(recording)
    names, (force, power) = recording.mounting.names, drive(recording)
    return Analysis(
        bag=str(recording.path),
        begin=segments.begin,
        duration=(segments.last - segments.begin) / NANO,
        settle=segments.settle,
        measured=segments.measured,
        rate=segments.rate,
        band=band(segments.rate),
        speed=speed,
        speed_deviation=speed_deviation,
        engine_speed=engine_speed,
        drive_force=force,
        drive_power=power,
        sensors=sensors,
        total_weighted={
            sensor: hypot(*(numbers.rms_weighted for numbers in axes.values())) for sensor, axes in sensors.items()
        },
        lines=lines,
        mounts={} if mounts is None else mount_numbers(mounts, names, segments.settled),
        demand={} if answers is None else currents(*answers, names, segments.settled),
        mount_energy=None if energy is None else energy._asdict(),
        loop=loop,
        messages=dict(sorted(recording.counts.items())),
        timing=segments.timing,
        spectra=spectra,
        history=build_history(recording, bins, levels),
        notes=(*find_notes(recording, segments), *why_fewer),
    )


def _speed(odometry, settled):
    """Return mean and standard deviation of the hull's speed [m/s] after a stamp [ns]; nan without odometry."""
    if odometry is None:
        return np.nan, np.nan
    found = moments(odometry.stamp, odometry.speed[:, None], settled)
    return float(found.mean[0]), float(found.deviation[0])
