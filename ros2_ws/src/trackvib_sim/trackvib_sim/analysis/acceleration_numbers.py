"""Numbers and spectra of the sensors over the segments that are measured."""

from .levels import Levels
from .mean_spectra import MeanSpectra
from .numbers import AXES, SENSORS
from .segments import segments_of


def measure_accelerations(recording, segments, bins, parts, on_progress):
    """Return the `Levels` by sensor, in `bins` and `parts`, and the `Spectra` of chassis and powertrain.

    Further sensors come after those two; one that is nowhere measured long enough is left out. A sensor that was
    resampled to the other one's rate has levels of its own rate.
    `on_progress(done, total)` is called now and then with the samples of the two that have been looked at.
    """
    levels = {sensor: Levels(segments.rate, bins, parts) for sensor in SENSORS}
    spectra = MeanSpectra(segments.rate)
    total, done = len(SENSORS) * sum(segment.size for segment in segments.segments), 0
    for segment in segments.segments:
        counting = []
        for sensor, first in zip(SENSORS, segment[:2], strict=True):
            inertial = getattr(recording, sensor)
            if sensor not in recording.own:
                for looked_at in _add(levels[sensor], inertial, first, segment):
                    on_progress(done + looked_at, total)
            done += segment.size
            counting.append(inertial.specific_force[first + segment.measured : first + segment.size])
        spectra.add(*counting)
    for name, inertial in {**recording.own, **recording.sensors}.items():
        rate, own = segments_of(inertial.stamp, segments)
        if own:
            levels[name] = Levels(rate, bins, parts)
            for segment in own:
                for _ in _add(levels[name], inertial, segment.chassis, segment):
                    pass
    return levels, spectra.spectra()


def _add(levels, inertial, first, segment):
    samples = slice(first, first + segment.size)
    return levels.add(inertial.stamp[samples], inertial.specific_force[samples], segment.measured)


def axis_numbers(levels):
    """Return `AxisNumbers` by sensor and axis of `Levels` by sensor."""
    return {sensor: dict(zip(AXES, found.numbers(), strict=True)) for sensor, found in levels.items()}
