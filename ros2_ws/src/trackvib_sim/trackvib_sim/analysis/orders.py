"""Order tracking: spectra over the engine's revolutions instead of time, so that an order stays a line as it speeds up.

The accelerations of each stretch in which one gear is engaged are interpolated (spline of fifth degree) at equal steps
of the crank's angle, which is the integral of the recorded engine speed, and cut into windows of whole revolutions.
"""

from math import ceil

import numpy as np
from scipy import signal
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import make_interp_spline

from ..numerics.units import NANO
from .motion import engine_speed_of, gear_of
from .numbers import AXES, SENSORS, OrderLevel, OrderSpectra
from .parts import parts_by
from .stamps import blocks

WINDOW = 10  # revolutions: a resolution of a tenth of an order
HALF_WIDTH = 0.25  # orders to either side of one: what a Hann window spreads a sine over, half orders told apart
STEP = 50.0  # r/min, width of the bands of engine speed
LEAST_BANDS = 4  # over which the speed varies, for orders to be tracked
SLOWEST, FASTEST = 300.0, 30_000.0  # r/min, between which an engine runs
HIGHEST = 10.0  # order of the spectra, or half as much again as the vehicle's highest
TRUSTED = 1.0 / 3.0  # of the sampling rate: up to it the spline keeps amplitudes within 2 %
BLOCK = 60  # windows at a time
MARGIN = 50  # samples about them, after which the spline's ends are forgotten


def track_orders(recording, segments, orders):
    """Return the `OrderLevel`s of some orders (m,) of the engine, and the `OrderSpectra`.

    Without a recorded engine speed, or if it does not vary, there are none: an empty tuple and None.
    """
    engine = engine_speed_of(recording)
    parts = None if engine is None else parts_by(engine, segments.settled, STEP)
    if parts is None or parts.count < LEAST_BANDS:
        return (), None
    highest = max(HIGHEST, 1.5 * max(orders, default=0.0))
    per_turn = ceil(60.0 * segments.rate / SLOWEST)  # never fewer samples a second than recorded: nothing folds back
    order = np.arange(min(round(highest * WINDOW), per_turn * WINDOW // 2) + 1) / WINDOW
    count, total = np.zeros(parts.count), np.zeros((parts.count, order.size * len(SENSORS) * len(AXES)))
    for stretch in _stretches(recording, segments, engine):
        for stamp, psd in _windows(recording, stretch, per_turn, order.size):
            within, sums = parts.sums(stamp, psd)
            count += within
            total += sums
    if not count.any():
        return (), None
    middle = 0.5 * (parts.edges[1:] + parts.edges[:-1])
    mean = (total / np.where(count > 0, count, np.nan)[:, None]).reshape(parts.count, order.size, len(SENSORS), -1)
    mean[np.outer(middle / 60.0, order) > TRUSTED * segments.rate] = np.nan
    psd = {sensor: mean[:, :, column] for column, sensor in enumerate(SENSORS)}
    spectra = OrderSpectra(middle, order, count.astype(np.int64), psd)
    return tuple(_levels(spectra, orders)), spectra


def _stretches(recording, segments, engine):
    """Iterate over stretches of one gear within a segment: (segment, time [s] and turns (k,) of the crank in it).

    Times are since the segment's first sample that counts.
    """
    gear = gear_of(recording).at(engine.stamp)
    steady = (engine.value >= SLOWEST) & (engine.value <= FASTEST) & np.isfinite(gear)
    changes = np.flatnonzero((np.diff(gear) != 0.0) | (np.diff(steady) != 0)) + 1
    for run in np.split(np.arange(len(gear)), changes):
        if len(run) < 2 or not steady[run[0]]:
            continue
        for segment in segments.segments:
            start = recording.chassis.stamp[segment.chassis + segment.measured]
            time = (engine.stamp[run] - start) / NANO
            yield segment, time, cumulative_trapezoid(engine.value[run] / 60.0, time, initial=0.0)


def _windows(recording, stretch, per_turn, size):
    """Iterate over blocks of windows: stamps of their middles (k,) and their spectra, a row a window."""
    (chassis, powertrain, whole, measured), time, turns = stretch
    stamp = recording.chassis.stamp[chassis + measured : chassis + whole]
    columns = [
        each.specific_force[first + measured : first + whole]
        for each, first in ((recording.chassis, chassis), (recording.powertrain, powertrain))
    ]
    since = (stamp - stamp[0]) / NANO
    begin, end = np.interp((max(since[0], time[0]), min(since[-1], time[-1])), time, turns)
    hop = WINDOW / 2
    count = int((end - begin) / hop) - 1
    for block in blocks(max(count, 0), BLOCK):
        windows = block.stop - block.start
        angle = begin + hop * block.start + np.arange(round((windows + 1) * hop) * per_turn) / per_turn
        instant = np.interp(angle, turns, time)
        first, last = np.searchsorted(since, instant[[0, -1]])
        around = slice(max(first - MARGIN, 0), last + MARGIN)
        known = np.hstack([np.array(each[around]) for each in columns])
        turned = make_interp_spline(since[around], known, k=5, check_finite=False)(instant)  # nan stays nan
        length = WINDOW * per_turn
        psd = signal.spectrogram(turned, per_turn, "hann", length, length // 2, detrend="constant", axis=0)[2]
        middle = instant[length // 2 :: length // 2][:windows]
        yield stamp[0] + np.round(middle * NANO).astype(np.int64), psd[:size].reshape(-1, windows).T


def _levels(spectra, orders):
    for row, windows in enumerate(spectra.windows):
        for order in orders if windows else ():
            about = np.abs(spectra.order - order) <= HALF_WIDTH + 1e-9
            rms = {sensor: np.sqrt(psd[row, about].sum(axis=0) / WINDOW) for sensor, psd in spectra.psd.items()}
            if np.isfinite(rms[SENSORS[0]]).any():
                by_axis = {sensor: dict(zip(AXES, each.tolist(), strict=True)) for sensor, each in rms.items()}
                yield OrderLevel(float(spectra.engine_speed[row]), float(order), int(windows), by_axis)
