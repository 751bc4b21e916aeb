"""From a recording to its `Analysis`: a table of contents."""

from collections.abc import Callable
from math import hypot, inf

from mr_mount_controller.node_base import topics

from ..bags.recording import Recording
from ..numerics.units import NANO
from .acceleration_numbers import axis_numbers, measure_accelerations
from .campbell import campbells
from .clocks.time_base import on_one_time_base
from .history import build_history
from .levels import build_bins
from .lines import known_lines, missing_causes, read_causes
from .loop_health import drive, loop_health, mount_energy
from .measured import unit_notes
from .motion import mean_motion
from .mount_numbers import currents, mount_numbers
from .notes import find_notes, rate_notes
from .numbers import INTERVAL, SENSORS, SPEED_BAND, Analysis
from .orders import track_orders
from .parts import build_parts, numbers_in_parts
from .placement import origin_words
from .segments import find_segments
from .vibration import band


def analyse(
    recording: Recording,
    settle: float | None = None,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
    interval: float = INTERVAL,
    speed_band: float = SPEED_BAND,
) -> Analysis:
    """Return the `Analysis` of a `bags.recording.Recording`.

    Parameters
    ----------
    recording : Recording
    settle : float, optional
        Time from the start that does not count, `SHORTEST_SETTLING` or more, s; by default `settling_of`.
    on_progress : callable
        Called from time to time with the number of samples done and their total number.
    interval : float
        Length of the distance intervals, m.
    speed_band : float
        Width of the speed bands, m/s.

    Raises
    ------
    TooShort
        No segment without gaps leaves a second for measurement.
    ValueError
        The settling time is too short, an interval or a band is not above 0, the sensors differ in their rates, or
        their stamps cannot be a time base.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> analysis = tv.analyse(tv.read_recording(bag))
    >>> bool(analysis.sensors["powertrain"]["z"].rms > 0.0)  # m/s^2, 0.5 Hz and above
    True
    """
    for name, value in (("interval", interval), ("speed_band", speed_band)):
        if not 0.0 < value < inf:
            raise ValueError(f"{name} is {value:g}, must be a number above 0")
    recording = on_one_time_base(recording)
    segments = find_segments(recording, settle)
    absent = {topics.imu_topic(sensor) for sensor in SENSORS if recording.origins and sensor not in recording.origins}
    segments = segments._replace(timing={end: each for end, each in segments.timing.items() if end not in absent})
    loop = loop_health(recording)
    bins = build_bins(segments.begin, segments.last)
    parts = build_parts(recording, segments.settled, interval, speed_band)
    levels, spectra = measure_accelerations(recording, segments, bins, parts, on_progress)
    sensors, rates = axis_numbers(levels), {sensor: found.rate for sensor, found in levels.items()}
    motion = mean_motion(recording, segments.settled)
    pitch, orders, no_vehicle = read_causes(recording)
    lines, unattributed = known_lines(spectra, motion, pitch, orders)
    order_levels, order_spectra = track_orders(recording, segments, orders)
    mounts, answers, energy = recording.mounts, recording.answers, mount_energy(recording)
    names, (force, power) = recording.mounting.names, drive(recording)
    return Analysis(
        bag=str(recording.path),
        begin=segments.begin,
        duration=(segments.last - segments.begin) / NANO,
        settle=segments.settle,
        measured=segments.measured,
        rate=segments.rate,
        rates=rates,
        origins={sensor: origin_words(origin) for sensor, origin in recording.origins.items()},
        band=band(segments.rate),
        **motion._asdict(),
        drive_force=force,
        drive_power=power,
        sensors=sensors,
        total_weighted={
            sensor: hypot(*(numbers.rms_weighted for numbers in axes.values())) for sensor, axes in sensors.items()
        },
        absorbed_power={sensor: found.absorbed_power() for sensor, found in levels.items()},
        motion_sickness={
            sensor: sickness for sensor, found in levels.items() if (sickness := found.motion_sickness()) is not None
        },
        lines=lines,
        **numbers_in_parts(parts, levels, recording, segments),
        order_levels=order_levels,
        order_spectra=order_spectra,
        campbell=campbells(recording, segments, pitch, orders),
        mounts={} if mounts is None else mount_numbers(mounts, names, segments.settled),
        demand={} if answers is None else currents(*answers, names, segments.settled),
        mount_energy=None if energy is None else energy._asdict(),
        loop=loop,
        messages=dict(sorted(recording.counts.items())),
        timing=segments.timing,
        clocks=recording.clocks,
        spectra=spectra,
        history=build_history(recording, bins, levels),
        notes=(
            *recording.notes,
            *find_notes(recording, segments),
            *rate_notes(rates),
            *unit_notes(sensors),
            *missing_causes(recording, motion),
            *no_vehicle,
            *unattributed,
        ),
    )
