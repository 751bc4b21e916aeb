"""What the tests of the views share: whether there is a viewer, and colours in its pictures."""

from importlib.util import find_spec

import numpy as np
import pytest

needs_viewer = pytest.mark.skipif(not find_spec("rerun"), reason="no rerun-sdk here: ./trackvib setup --view")
TYRE, ROAD, CHASSIS, POWERTRAIN = (84, 92, 99), (176, 162, 137), (59, 110, 165), (209, 102, 43)


def near(picture, colour, distance):
    """How many pixels (h, w, 3) are of about a colour."""
    return int((np.abs(picture.astype(int) - colour).max(axis=-1) < distance).sum())
