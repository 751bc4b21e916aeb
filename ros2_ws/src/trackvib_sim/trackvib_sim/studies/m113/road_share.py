"""How much of a history follows the road linearly: least squares on the road under the stations.

A hull on springs answers to heights under its stations as an oscillator does, each with a weight of its own. What no
weights can give is no linear answer to the road: contacts that come and go make it, or tracks by themselves.
"""

import numpy as np

from .measures import ROAD_BORNE, within
from .reference import RATE, ROUGH, road_of

HEAVE, DAMPING = 3.1, 0.2  # Hz and damping ratio of the oscillator; the shares hardly depend on them
_BEFORE = 20.0  # m of road before the history, in which the oscillator forgets its start


def road_share(road_borne, place, speed, wheel_x):
    """Return the share of a road-borne part (k,) [m/s^2] that follows the rough road; 5 % do by chance.

    `place` (k,) [m] is where the vehicle is at each millisecond, `wheel_x` (2, n) [m] where its axles are from there,
    left and right.
    """
    first, last = place[0] - _BEFORE, place[-1]
    way = np.arange(first, last, speed / RATE)
    answers = np.array([_answer(way, left, right) for left, right in wheel_x.T])
    answers = np.array([within(np.interp(place, way, answer), RATE, ROAD_BORNE) for answer in answers])
    rest = road_borne - np.linalg.lstsq(answers.T, road_borne, rcond=None)[0] @ answers
    return float(1.0 - (rest**2).sum() / (road_borne**2).sum())


def _answer(way, left, right):
    """Return the acceleration (k,) [m/s^2] of an oscillator on the mean of the heights under a pair of wheels."""
    road = road_of(ROUGH)
    first = int(np.floor((way[0] + min(left, right)) / road.spacing))
    count = int(np.ceil((way[-1] + max(left, right)) / road.spacing)) - first + 2
    heights, at = road.heights(first, count), road.spacing * (first + np.arange(count))
    mean = 0.5 * (np.interp(way + left, at, heights[0]) + np.interp(way + right, at, heights[1]))
    s = 2j * np.pi * np.fft.rfftfreq(2 * len(way), 1.0 / RATE)
    natural = 2.0 * np.pi * HEAVE
    passes = natural**2 + 2.0 * DAMPING * natural * s
    return np.fft.irfft(np.fft.rfft(mean, 2 * len(way)) * s**2 * passes / (passes + s**2), 2 * len(way))[: len(way)]
