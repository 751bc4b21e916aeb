"""Numbers and spectra of both sensors over the segments that are measured."""

from .levels import Levels
from .mean_spectra import MeanSpectra
from .numbers import AXES, SENSORS


def measure_accelerations(recording, segments, bins, parts, on_progress):
    """Return `AxisNumbers` by sensor and axis, the `Spectra`, and the `Levels` by sensor, in `bins` and `parts`.

    `on_progress(done, total)` is called now and then with the samples that have been looked at.
    """
    levels = {sensor: Levels(segments.rate, bins, parts) for sensor in SENSORS}
    spectra = MeanSpectra(segments.rate)
    total, done = len(SENSORS) * sum(segment.size for segment in segments.segments), 0
    for segment in segments.segments:
        counting = []
        for sensor, first in zip(SENSORS, segment[:2], strict=True):
            of_sensor = getattr(recording, sensor)
            stamp, acceleration, _ = (column[first : first + segment.size] for column in of_sensor)
            for looked_at in levels[sensor].add(stamp, acceleration, segment.measured):
                on_progress(done + looked_at, total)
            done += segment.size
            counting.append(acceleration[segment.measured :])
        spectra.add(*counting)
    sensors = {sensor: dict(zip(AXES, levels[sensor].numbers(), strict=True)) for sensor in SENSORS}
    return sensors, spectra.spectra(), levels
