"""Colours of what is drawn, red, green and blue, those of the vehicle's drawing."""

import numpy as np

INK, TYRE, DISC, SHOE, PIN = (60, 66, 72), (84, 92, 99), (227, 232, 235), (78, 84, 90), (150, 152, 152)
DAMPED = (59, 110, 165)  # swing arms with a shock absorber
SHADES = (
    (205, 213, 219),
    (184, 196, 204),
    (160, 174, 184),
    (140, 156, 167),
    (122, 139, 151),
)  # of hull, on it, on that
POWERTRAIN_SHADE = (224, 140, 92)
SENSORS = {"chassis": (59, 110, 165), "powertrain": (209, 102, 43)}
OTHER_SENSOR = (46, 125, 90)
_LOW, _MIDDLE, _HIGH = np.array([(66, 104, 168), (240, 228, 150), (196, 49, 40)], dtype=float)
_VALLEY, _LEVEL, _HILL = np.array([(92, 86, 76), (150, 140, 122), (214, 204, 180)], dtype=float)


def of_load(share):
    """Return the colours (..., 3) uint8 of loads, from blue at 0 over yellow to red at 1."""
    return _ramp(np.clip(share, 0.0, 1.0), _LOW, _MIDDLE, _HIGH)


def of_height(share):
    """Return the colours (..., 3) uint8 of a road's heights, from dark at 0 to light at 1."""
    return _ramp(np.clip(share, 0.0, 1.0), _VALLEY, _LEVEL, _HILL)


def _ramp(share, low, middle, high):
    share = np.asarray(share, dtype=float)[..., None]
    lower, upper = low + 2.0 * share * (middle - low), middle + (2.0 * share - 1.0) * (high - middle)
    return np.where(share < 0.5, lower, upper).round().astype(np.uint8)
