"""Road profiles as CSV: a column of distances and one or two of heights, with their units in the names.

    distance_m,left_m,right_m          or          distance_m,height_mm

Units are m, cm, mm, km, in and ft.
"""

from pathlib import Path

import numpy as np
from mr_mount_controller.node_base.plain_text import readable

from ..csv_columns import METRES, CsvError, read_columns
from ..road.profile import MOST, ProfileError, checked

COLUMNS = (("distance", "left", "right"), ("distance", "height"))
_UNITS = {quantity: METRES for names in COLUMNS for quantity in names}


def read_csv_profile(path):
    """Return the `profile.Profile` in a CSV file.

    Raises
    ------
    ProfileError
        The file cannot be used; the message names it, the line or column and what is accepted.
    OSError
        It cannot be read.
    """
    try:
        distance, *heights = read_columns(path, _UNITS, COLUMNS, (), MOST).values()
    except CsvError as error:
        raise ProfileError(str(error)) from None
    return checked(distance, np.array([heights[0], heights[-1]]), readable(str(path)))


def write_csv_profile(path, distance, heights):
    """Write a profile of a distance (n,) and heights (2, n) [m]; every number comes back to the last bit."""
    with Path(path).open("w", encoding="utf-8") as file:
        file.write("distance_m,left_m,right_m\n")
        for values in zip(distance, *heights, strict=True):
            file.write(",".join(repr(float(value)) for value in values) + "\n")
