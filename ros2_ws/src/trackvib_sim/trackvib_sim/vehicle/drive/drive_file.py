"""Drive files: what is wanted of the driver over time or distance, in YAML or CSV.

    over: time                      # s from the start of the run; or distance, m along the path
    points:
      - {at: 0, speed: 5}           # m/s; linear between points, constant before the first and after the last
      - {at: 10, speed: 12}
      - {at: 20, speed: 12, curvature: 0.02}   # 1/m, to the left; 0 where nothing is said

Points may have an `engine_speed` [r/min], all of them or none. As CSV it is a column of times or distances, one of
speeds, and whichever of the others there are, with their units in the names:

    time_s,speed_kmh          or          distance_m,speed_mps,curvature_1/m,engine_speed_rpm
"""

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from ...csv_columns import METRES, CsvError, read_columns
from ...numerics.units import RPM
from ...yaml_text import YamlTextError, read_text, validated
from .command import check_curvature, check_speed
from .limits import FASTEST
from .path import HIGHEST_CURVATURE
from .schedule import Schedule

MOST_POINTS = 20_000
SLOWEST_BY_DISTANCE = 0.1  # m/s; who stands never gets to the next point
_LARGEST_AT = 1e6  # s or m

_UNITS = {
    "time": {"s": 1.0, "min": 60.0},
    "distance": METRES,
    "speed": {"mps": 1.0, "kmh": 1.0 / 3.6, "mph": 0.44704},
    "curvature": {"1/m": 1.0},
    "engine_speed": {"rpm": 1.0},
}
_LAYOUTS = (("time", "speed"), ("distance", "speed"))

Speed = Annotated[
    float, Field(allow_inf_nan=False, json_schema_extra={"unit": "m/s", "minimum": -FASTEST, "maximum": FASTEST})
]
Curvature = Annotated[
    float,
    Field(
        allow_inf_nan=False,
        json_schema_extra={"unit": "1/m", "minimum": -HIGHEST_CURVATURE, "maximum": HIGHEST_CURVATURE},
    ),
]


class DriveFileError(ValueError):
    """A drive file that cannot be used; the message names file, item, value and what is accepted."""


class DrivePoint(BaseModel):
    """What is wanted at one time or distance."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    at: Annotated[float, Field(ge=-_LARGEST_AT, le=_LARGEST_AT, json_schema_extra={"unit": "s or m"})]
    """Time or distance of the point; each above the one before."""
    speed: Speed
    """Wanted speed; at least 0.1 m/s over distance."""
    curvature: Curvature = 0.0
    """Curvature of the path, positive to the left; 0 in reverse."""
    engine_speed: Annotated[float, Field(ge=0.0, le=10_000.0, json_schema_extra={"unit": "r/min"})] | None = None
    """Wanted engine speed, in all points or in none; of the run where left out."""

    @model_validator(mode="after")
    def _can_be_driven(self):
        check_speed(self.speed)
        check_curvature(self.speed, self.curvature)
        return self


class DriveFile(BaseModel):
    """The whole file."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    over: Literal["time", "distance"] = "time"
    """Whether points are at times from the start of the run, or at distances along the path."""
    points: Annotated[list[DrivePoint], Field(min_length=1, max_length=MOST_POINTS)]
    """Points; linear in between, constant before and after."""

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
    """Return the text of a drive file, as a bag keeps it: in YAML, whatever the file is in.

    Raises
    ------
    DriveFileError
        It cannot be read.
    """
    try:
        return _from_csv(path) if Path(path).suffix.lower() == ".csv" else read_text(path, "drive file")
    except (YamlTextError, CsvError) as error:
        raise DriveFileError(str(error)) from None
    except OSError as error:
        raise DriveFileError(f"drive file {str(path)!r} cannot be read: {error.strerror}") from None


def _from_csv(path):
    columns = read_columns(path, _UNITS, _LAYOUTS, ("curvature", "engine_speed"), MOST_POINTS)
    over = next(iter(columns))
    names = ["at", *list(columns)[1:]]
    lines = [f"over: {over}", "points:"]
    for values in zip(*(column.tolist() for column in columns.values()), strict=True):
        items = (f"{name}: {_number(value)}" for name, value in zip(names, values, strict=True))
        lines.append(f"- {{{', '.join(items)}}}")
    return "\n".join(lines) + "\n"


def _number(value):
    """A number in YAML, to the last bit; what is none is refused with the others."""
    words = {"inf": ".inf", "-inf": "-.inf", "nan": ".nan"}
    return words.get(str(value)) or repr(value).replace("e", ".0e" if "." not in repr(value) else "e")


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
