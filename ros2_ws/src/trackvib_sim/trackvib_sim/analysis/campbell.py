"""Campbell diagrams: spectra of the vertical in bands of a speed that varies, and where lines of known cause lie."""

import numpy as np
from scipy import signal

from ..numerics.units import NANO
from .lines import HARMONICS
from .motion import engine_speed_of, gear_of, shifts_of, speed_of
from .numbers import AXES, SENSORS, Campbell, Ray
from .orders import LEAST_BANDS, STEP
from .parts import parts_by
from .stamps import blocks

WINDOW = 0.5  # s: bins of 2 Hz
SPEED_STEP = 0.5  # m/s, width of the bands of speed
BLOCK = 240  # windows at a time
VERTICAL = AXES.index("z")
LEAST_SAMPLES = 10  # of a drive in one gear, for the ratio to be told


def campbells(recording, segments, pitch, orders):
    """Return a `Campbell` over the engine's recorded speed and one over the hull's, of those that vary.

    Parameters
    ----------
    recording : Recording
    segments : Segments
    pitch : float
        Of the tracks, m; nan if unknown.
    orders : sequence of float
        Of the engine, cycles a revolution.
    """
    engine, speed = engine_speed_of(recording), speed_of(recording)
    by_gear = _by_gear(recording, engine, speed, segments.settled)
    found = []
    for over, unit, slow, step, rays in (
        ("engine speed", "r/min", engine, STEP, _over_engine_speed),
        ("speed", "m/s", speed, SPEED_STEP, _over_speed),
    ):
        parts = None if slow is None else parts_by(slow, segments.settled, step)
        if parts is None or parts.count < LEAST_BANDS:
            continue
        frequency, psd = _mean_spectra(recording, segments, parts)
        if frequency is not None:
            ends = parts.edges[[0, -1]]
            middle = 0.5 * (parts.edges[1:] + parts.edges[:-1])
            found.append(Campbell(over, unit, middle, frequency, psd, tuple(rays(ends, by_gear, pitch, orders))))
    return tuple(found)


def _mean_spectra(recording, segments, parts):
    """Return frequencies [Hz] and mean spectra (n, f) by sensor in parts; None of segments shorter than a window.

    A window in which gears are shifted, and the engine's speed jumps, counts nowhere.
    """
    shifts = shifts_of(recording)
    length = round(WINDOW * segments.rate)
    hop = length - length // 2
    frequency, psd = None, {}
    for column, sensor in enumerate(SENSORS):
        count, total = np.zeros(parts.count), 0.0
        for segment in segments.segments:
            first, last = segment[column] + segment.measured, segment[column] + segment.size
            of_sensor = getattr(recording, sensor)
            stamp, vertical = of_sensor.stamp[first:last], of_sensor.specific_force[first:last, VERTICAL]
            for block in blocks(max((len(stamp) - length // 2) // hop, 0), BLOCK):
                samples = slice(block.start * hop, (block.stop - 1) * hop + length)
                frequency, _, found = signal.spectrogram(
                    np.array(vertical[samples]), segments.rate, "hann", length, length // 2, detrend="constant"
                )
                begin = stamp[samples][::hop][: found.shape[1]]
                kept = np.diff(np.searchsorted(shifts, (begin, begin + round(WINDOW * NANO))), axis=0)[0] == 0
                within, sums = parts.sums(begin[kept] + round(0.5 * WINDOW * NANO), found.T[kept])
                count, total = count + within, total + sums
        psd[sensor] = total / np.where(count > 0, count, np.nan)[:, None]
    return frequency, psd


def _by_gear(recording, engine, speed, settled):
    """Return, by gear, least and greatest engine speed [r/min] and speed [m/s] and their mean ratio [m/s/(r/min)].

    The ratio of an engine that turned at a speed of its own (gear 0) is nan.
    """
    if engine is None or speed is None:
        return {}
    engine = engine.after(settled)
    gear, driven = gear_of(recording).at(engine.stamp), speed.at(engine.stamp)
    found = {}
    for each in np.unique(gear[np.isfinite(gear)]):
        here = (gear == each) & np.isfinite(driven)
        if here.sum() >= LEAST_SAMPLES:
            turned, moved = engine.value[here], driven[here]
            ratio = moved.sum() / turned.sum() if each and turned.sum() else np.nan
            found[int(each)] = (turned.min(), turned.max()), (moved.min(), moved.max()), ratio
    return found


def _over_engine_speed(ends, by_gear, pitch, orders):
    for order in orders:
        yield _ray(f"engine order {order:g}", ends, order / 60.0)
    for gear, (turned, _, ratio) in by_gear.items():
        for harmonic in range(1, HARMONICS + 1):
            if np.isfinite(slope := harmonic * abs(ratio) / pitch):
                yield _ray(f"link passing {harmonic}, gear {gear}", turned, slope)


def _over_speed(ends, by_gear, pitch, orders):
    for harmonic in range(1, HARMONICS + 1):
        if np.isfinite(slope := harmonic / pitch):
            yield _ray(f"link passing {harmonic}", ends, slope)
    for gear, (turned, moved, ratio) in by_gear.items():
        for order in orders:
            if gear and ratio:
                yield _ray(f"engine order {order:g}, gear {gear}", moved, order / 60.0 / ratio)
            elif np.ptp(turned) < STEP:  # at a speed of its own that it keeps
                level = float(order * np.mean(turned) / 60.0)
                yield Ray(f"engine order {order:g}", tuple((float(each), level) for each in ends))


def _ray(name, ends, slope):
    return Ray(name, tuple((float(each), float(abs(slope * each))) for each in ends))
