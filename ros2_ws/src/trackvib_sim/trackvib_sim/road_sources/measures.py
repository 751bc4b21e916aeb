"""What a road is like: its PSD beside the classes of ISO 8608, its international roughness index, its level."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy import signal

from ..road.classes import CLASSES
from ..road.iso8608 import REFERENCE_FREQUENCY, roughness_of

# the golden car of [Sayers1995], over its sprung mass: tyre, suspension and damper, and the unsprung mass
# [Sayers1995] M. W. Sayers, On the calculation of international roughness index from longitudinal road profile,
# Transportation Research Record 1501 (1995) 1-12.
_TYRE, _SPRING, _DAMPER, _UNSPRUNG = 653.0, 63.3, 6.0, 0.15  # 1/s^2, 1/s^2, 1/s, -
_SPEED = 80.0 / 3.6  # m/s
_TYRE_LENGTH = 0.25  # m, over which its contact averages
_SMOOTH = 11.0  # m from which the car's first state is set
FITTED = 0.011, 2.83  # 1/m, the standard's range
_BANDS = 3  # an octave, of the smoothed PSD
_SEGMENT = 200.0  # m, of the PSD's windows where the road is long enough
_FEWEST_BANDS = 4
_OFF_LINE = 6.0  # dB RMS of the third octaves about their line: random roads of 100 m or more stay within 5
_OF_STANDARD = 1.5, 2.5  # waviness, of roads that the classes of the standard are for; theirs is 2


class Measures(NamedTuple):
    """Of one side of a road."""

    rms: float  # m, of the heights about their straight line
    iri: float  # m/km; not a number of a road shorter than the first state needs
    level: float  # G_d(n0) of the fitted line, m^3; not a number where the PSD has too few bands or is no line
    waviness: float
    road_class: str  # by the standard's limits of G_d(n0); empty of a road whose PSD is not like the standard's


def measures(heights, spacing):
    """Return the `Measures` of heights (n,) [m] that are `spacing` [m] apart."""
    line = signal.detrend(heights)
    level, waviness = _fitted(heights, spacing)
    of_standard = _OF_STANDARD[0] <= waviness <= _OF_STANDARD[1]
    road_class = _class(level) if of_standard else ""
    return Measures(float(np.sqrt(np.mean(line**2))), roughness_index(heights, spacing), level, waviness, road_class)


def psd(heights, spacing):
    """Return spatial frequencies [1/m] and the one-sided PSD [m^3], by Welch's method."""
    segment = min(len(heights), max(round(_SEGMENT / spacing), 8))
    frequency, density = signal.welch(heights, fs=1.0 / spacing, nperseg=segment, detrend="linear")
    return frequency[1:], density[1:]


def smoothed(heights, spacing):
    """Return centres [1/m] and mean PSD [m^3] of third-octave bands within the standard's range, as [ISO8608] does."""
    frequency, density = psd(heights, spacing)
    count = int(np.floor(_BANDS * np.log2(FITTED[1] / FITTED[0])))
    edges = FITTED[0] * 2.0 ** (np.arange(count + 1) / _BANDS)
    bands = [(low, high, density[(low <= frequency) & (frequency < high)]) for low, high in pairwise(edges)]
    bands = [(np.sqrt(low * high), inside.mean()) for low, high, inside in bands if inside.size and inside.mean() > 0.0]
    return np.array(bands).reshape(-1, 2).T


def roughness_index(heights, spacing):
    """Return the IRI [m/km]: the golden car's suspension motion at 80 km/h over the road, [Sayers1995]."""
    if len(heights) * spacing < 2.0 * _SMOOTH:
        return np.nan
    window = max(round(_TYRE_LENGTH / spacing), 1)
    smooth = np.convolve(heights, np.full(window, 1.0 / window), mode="valid")
    slope = np.diff(smooth) / spacing
    # states: slopes of sprung and unsprung mass's heights, and their rates, per metre driven
    a = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-_SPRING, -_DAMPER, _SPRING, _DAMPER],
            [0.0, 0.0, 0.0, 1.0],
            [_SPRING / _UNSPRUNG, _DAMPER / _UNSPRUNG, -(_SPRING + _TYRE) / _UNSPRUNG, -_DAMPER / _UNSPRUNG],
        ]
    )
    b = np.array([[0.0], [0.0], [0.0], [_TYRE / _UNSPRUNG]])
    discrete = signal.cont2discrete((a, b, np.eye(4), np.zeros((4, 1))), spacing / _SPEED, method="zoh")
    begin = slope[: max(round(_SMOOTH / spacing), 1)].mean()
    _, motion, _ = signal.dlsim((*discrete[:4], discrete[4]), slope, x0=[begin, 0.0, begin, 0.0])
    return float(1e3 * np.abs(motion[:, 0] - motion[:, 2]).mean())


def _fitted(heights, spacing):
    centre, density = smoothed(heights, spacing)
    if len(centre) < _FEWEST_BANDS:
        return np.nan, np.nan
    along = np.log(centre / REFERENCE_FREQUENCY)
    waviness, level = np.polyfit(along, np.log(density), 1)
    off = np.log(density) - level - waviness * along
    if 10.0 / np.log(10.0) * np.sqrt(np.mean(off**2)) > _OFF_LINE:
        return np.nan, np.nan  # waves and steps have no line
    return float(np.exp(level)), float(-waviness)


def _class(level):
    if not level > 0.0:
        return ""
    # limits lie at twice the classes' geometric means
    limits = [2.0 * roughness_of(each).level for each in CLASSES[:-1]]
    return CLASSES[int(np.searchsorted(limits, level))]
