"""What a calibration may change and how it searches: its plan, read from a YAML file and checked."""

import re
from math import exp, isfinite, log
from sys import float_info
from typing import Annotated, Literal

from mr_mount_controller.node_base.plain_text import readable, shortened
from pydantic import BaseModel, ConfigDict, Field, model_validator

from ...vehicle.vehicle_file import parse_vehicle
from ...yaml_text import YamlTextError, read_text, validated
from .vehicle_text import calibrated_vehicle_text

DIGITS = 4  # of every value that is tried, so that what the file says is what was run
_ITEM = re.compile(r"([a-z_]\w*(?:\.[a-z_]\w*){1,3})(?:\[(\d)\])?")

Bound = Annotated[float, Field(allow_inf_nan=False)]


class PlanError(ValueError):
    """A plan that cannot be used; the message names file, item, value and what is accepted."""


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Parameter(_Strict):
    """A number of the vehicle file that may vary; sections may lie in others: `bodies.turret.mass`."""

    item: Annotated[str, Field(description="Item of the vehicle file: `section.item`, or `section.item[0]`.")]
    low: Annotated[Bound, Field(description="Least value that is tried, in the item's unit.")]
    high: Annotated[Bound, Field(description="Greatest value that is tried.")]
    scale: Annotated[Literal["linear", "log"], Field(description="How the search divides the range; log above 0.")]
    source: Annotated[str, Field(min_length=1, description="Where the bounds come from.")]

    @model_validator(mode="after")
    def _usable(self):
        if not _ITEM.fullmatch(self.item):
            raise ValueError(f"item is {self.item!r}, must be written section.item or section.item[0]")
        if not self.low < self.high:
            raise ValueError(f"{self.item}: low is {self.low:g} and high {self.high:g}, low must be below high")
        if self.scale == "log" and self.low <= 0.0:
            raise ValueError(f"{self.item}: low is {self.low:g}, must be > 0 on a log scale")
        if self.scale == "log" and not isfinite(self.high / self.low):
            raise ValueError(
                f"{self.item}: low is {self.low:g}, must be at least {self.high / float_info.max:.2g} on a log scale"
            )
        return self

    @property
    def quantity(self):
        """`section.item` without the number of the element."""
        return _ITEM.fullmatch(self.item)[1]

    @property
    def component(self):
        """Which element of a list it is, or None where the quantity is one number."""
        element = _ITEM.fullmatch(self.item)[2]
        return None if element is None else int(element)

    def value(self, share):
        """Return the value at a share (0 to 1) of the range, rounded to `DIGITS` digits."""
        if self.scale == "log":
            value = self.low * exp(share * log(self.high / self.low))
        else:
            value = self.low + share * (self.high - self.low)
        return min(max(float(f"{value:.{DIGITS}g}"), self.low), self.high)

    def share(self, value):
        """Return which share of the range lies below a value; beyond the bounds it is 0 or 1."""
        value = min(max(value, self.low), self.high)
        if self.scale == "log":
            return log(value / self.low) / log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def of(self, vehicle):
        """Return its value in a vehicle."""
        value = vehicle
        for name in self.quantity.split("."):
            value = value[name] if isinstance(value, dict) else getattr(value, name)
        if isinstance(value, list):  # also one number for both sides or all stations
            return value[self.component or 0]
        return value


class Plan(_Strict):
    """The whole file."""

    rows: Annotated[
        list[tuple[str, float]],
        Field(min_length=1, description="Rows of the paper's table to fit: class of the road, speed in m/s."),
    ]
    seeds: Annotated[
        int, Field(ge=1, le=100, description="Runs of each row, each with its own road and phase between the tracks.")
    ]
    measuring: Annotated[
        float, Field(ge=1.0, le=60.0, description="Length of each run after settling.", json_schema_extra={"unit": "s"})
    ]
    population: Annotated[int, Field(ge=4, le=1000, description="Candidates of a generation.")]
    generations: Annotated[int, Field(ge=1, le=100000, description="Length of the search.")]
    step: Annotated[
        float, Field(gt=0.0, le=0.5, description="First standard deviation of the search, as a part of each range.")
    ]
    seed: Annotated[int, Field(ge=0, le=2**32 - 1, description="Seed of the search.")]
    parameters: Annotated[list[Parameter], Field(min_length=2, description="Parameters that may vary.")]

    @model_validator(mode="after")
    def _each_once(self):
        items = [parameter.item for parameter in self.parameters]
        for item in items:
            if items.count(item) > 1:
                raise ValueError(f"parameters: {item} is given {items.count(item)} times, must be given once")
        return self

    @property
    def items(self):
        """Names of all parameters."""
        return [parameter.item for parameter in self.parameters]

    def values(self, shares):
        """Return a value of each parameter, from shares of their ranges."""
        return [parameter.value(share) for parameter, share in zip(self.parameters, shares, strict=True)]

    def shares(self, values):
        """Return shares of the ranges, from a value of each parameter."""
        return [parameter.share(value) for parameter, value in zip(self.parameters, values, strict=True)]


def read_plan(path, vehicle_text, given):
    """Return the `Plan` in a YAML file, whose parameters and bounds a vehicle file accepts.

    `given` are the rows (class, speed) that there are.

    Raises
    ------
    PlanError
        The file cannot be read, is not a plan, or does not go with the vehicle file.
    """
    try:
        plan = validated(Plan, read_text(path, "calibration plan"), str(path))
    except YamlTextError as error:
        raise PlanError(str(error)) from None
    for row in plan.rows:
        if row not in given:
            known = ", ".join(f"[{road_class}, {speed:g}]" for road_class, speed in given)
            name = readable(shortened(row[0]))
            raise PlanError(f"{path}: rows: [{name}, {row[1]:g}] is not in the paper's table, which gives {known}")
    for side in ("low", "high"):
        bounds = [getattr(parameter, side) for parameter in plan.parameters]
        try:
            parse_vehicle(
                calibrated_vehicle_text(vehicle_text, plan.parameters, bounds), f"vehicle with all {side} bounds"
            )
        except ValueError as error:
            raise PlanError(f"{path}: {error}") from None
    return plan
