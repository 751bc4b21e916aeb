"""Drive files: what is wanted of the driver over time or distance, in YAML.

    over: time                      # s from the start of the run; or distance, m along the path
    points:
      - {at: 0, speed: 5}           # m/s; linear between points, constant before the first and after the last
      - {at: 10, speed: 12}
      - {at: 20, speed: 12, curvature: 0.02}   # 1/m, to the left; 0 where nothing is said

Points may have an `engine_speed` [r/min], all of them or none.
"""

from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from ...numerics.units import RPM
from ...yaml_text import YamlTextError, read_text, validated
from .command import check_curvature, check_speed
from .schedule import Schedule

MOST_POINTS = 20_000
SLOWEST_BY_DISTANCE = 0.1  # m/s; who stands never gets to the next point
_LARGEST_AT = 1e6  # s or m

Number = Annotated[float, Field(allow_inf_nan=False)]


class DriveFileError(ValueError):
    """A drive file that cannot be used; the message names file, item, value and what is accepted."""


class DrivePoint(BaseModel):
    """What is wanted at one time or distance."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    at: Annotated[float, Field(ge=-_LARGEST_AT, le=_LARGEST_AT)]
    speed: Number
    curvature: Number = 0.0
    engine_speed: Annotated[float, Field(ge=0.0, le=10_000.0)] | None = None

    @model_validator(mode="after")
    def _can_be_driven(self):
        check_speed(self.speed)
        check_curvature(self.speed, self.curvature)
        return self


class DriveFile(BaseModel):
    """The whole file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    over: Literal["time", "distance"] = "time"
    points: Annotated[list[DrivePoint], Field(min_length=1, max_length=MOST_POINTS)]

    @model_validator(mode="after")
    def _in_order(self):
        for number, (one, other) in enumerate(pairwise(self.points), 2):
            if other.at <= one.at:
                raise ValueError(f"point {number}: at is {other.at:g}, must be above {one.at:g} of the point before")
        told = sum(point.engine_speed is not None for point in self.points)
        if told not in (0, len(self.points)):
            raise ValueError(f"{told} of {len(self.points)} points have an engine_speed, must be all or none")
        if self.over == "distance":
            for number, point in enumerate(self.points, 1):
                if point.speed < SLOWEST_BY_DISTANCE:
                    raise ValueError(
                        f"point {number}: speed is {point.speed:g} m/s, over distance at least {SLOWEST_BY_DISTANCE:g} "
                        "m/s is accepted"
                    )
        return self


def drive_text(path):
    """Return the text of a drive file, as a bag keeps it.

    Raises
    ------
    DriveFileError
        It cannot be read.
    """
    try:
        return read_text(path, "drive file")
    except YamlTextError as error:
        raise DriveFileError(str(error)) from None


def parse_drive(text, engine_speed, name):
    """Return the `Schedule` that a text called `name` describes, with an engine speed [r/min] where it gives none.

    Raises
    ------
    DriveFileError
        It cannot be used.
    """
    try:
        drive = validated(DriveFile, text, name)
    except YamlTextError as error:
        raise DriveFileError(str(error)) from None
    told = drive.points[0].engine_speed is not None
    return Schedule(
        by_distance=drive.over == "distance",
        at=np.array([point.at for point in drive.points]),
        speed=np.array([point.speed for point in drive.points]),
        curvature=np.array([point.curvature for point in drive.points]),
        engine_speed=RPM * np.array([point.engine_speed if told else engine_speed for point in drive.points]),
    )
