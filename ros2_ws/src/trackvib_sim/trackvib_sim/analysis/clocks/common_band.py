"""Sensors at different rates: what needs both is computed at the instants of the slower one, on the band of both."""

import numpy as np

from ..stamps import period_of, timing
from .resampling import resampled


def on_common_band(pair, alike):
    """Return a pair of `Inertial`s by sensor at the slower one's instants, the faster one as it was, and notes.

    Parameters
    ----------
    pair : dict
        sensor -> `Inertial`, with even stamps.
    alike : float
        Relative difference of two rates up to which they are one, and nothing is done.

    Returns
    -------
    pair : dict
    own : dict
        sensor -> `Inertial`, of the faster one; empty where nothing was done.
    notes : list of str
    """
    periods = {sensor: period_of(inertial.stamp) for sensor, inertial in pair.items()}
    fast, slow = sorted(pair, key=periods.get)
    ratio = periods[fast] / periods[slow]
    if not ratio < 1.0 - alike:
        return pair, {}, []
    moved, found = pair[fast], {"stamp": [], "force": []}
    edges = [0, *timing(moved.stamp, 0)[1].tolist(), len(moved.stamp)]
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        own = moved.stamp[begin:end]
        first, last = np.searchsorted(pair[slow].stamp, (own[0], own[-1] + 1))
        if last > first and end - begin > 1:
            at = np.array(pair[slow].stamp[first:last])
            place = np.interp((at - own[0]).astype(float), (own - own[0]).astype(float), np.arange(end - begin))
            found["stamp"].append(at)
            found["force"].append(resampled(moved.specific_force[begin:end], place, ratio))
    if not found["stamp"]:
        return pair, {}, []
    common = type(moved)(np.concatenate(found["stamp"]), np.concatenate(found["force"]))
    rates = {sensor: 1e9 / period for sensor, period in periods.items()}
    note = (
        f"{fast}/imu is sampled at {rates[fast]:.6g} Hz and {slow}/imu at {rates[slow]:.6g} Hz: each has numbers at "
        f"its own rate; spectra, lines, transmissibility and coherence reach {0.5 * rates[slow]:.4g} Hz, and "
        f"{fast}/imu was resampled for them, band-limited"
    )
    return {**pair, fast: common}, {fast: moved}, [note]
