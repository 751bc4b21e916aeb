"""Parameters of suspension and wheels: their sections of a vehicle file.

A quantity by station is one number for all stations of both sides, or a list from the front station to the rear one.
"""

from math import radians, sin

import numpy as np
from pydantic import model_validator

from .quantities import one_or_many, scalar, vector, words
from .sections import Gain, Length, Mass, RigidBodyParameters, Section

MOST_STATIONS = 12
MOST_ROLLERS = 12

by_station = lambda unit, **limits: one_or_many(unit, MOST_STATIONS, **limits)  # noqa: E731 - reads as a type


class SwingArmsParameters(RigidBodyParameters):
    """Swing arms with torsion bars and bump stops; stiffness and damping as seen at the wheel.

    Mass and inertia are those of the left trailing arm, from its pivot; others mirror it.
    """

    length: Length
    """Distance from pivot to wheel axle."""
    static_angle: scalar("deg", gt=-80.0, lt=80.0)
    """Angle of the arm below the horizontal at static ride height."""
    direction: words(MOST_STATIONS, "trailing", "leading")
    """Whether the wheel is behind its pivot (trailing) or ahead of it."""
    pivot_y: Length
    """Distance of the pivots from the middle of the vehicle."""
    wheel_x: vector("m", most=MOST_STATIONS)
    """Wheel axles at static ride height, from front to rear; of the left side if the right side differs."""
    right_wheel_x: vector("m", most=MOST_STATIONS) | None = None
    """The same of the right side; as the left one where left out."""
    wheel_rate: by_station("N/m", gt=0.0)
    """Vertical stiffness at the wheel at static ride height."""
    preload: by_station("N m", ge=0.0) | None = None
    """Torque of the bar at static ride height; an equal share of the weight where left out."""
    friction: by_station("N s/m", ge=0.0)
    """Damping of the bearings, as seen at the wheel."""
    bump_travel: by_station("m", gt=0.0)
    """Rise of the wheel from static ride height to the bump stop."""
    bump_stiffness: by_station("N/m", ge=0.0)
    """Stiffness of the bump stop, at the wheel."""
    bump_damping: by_station("N s/m", ge=0.0)
    """Damping of the bump stop, at the wheel."""

    @property
    def stations(self):
        """How many there are a side."""
        return len(self.wheel_x)

    @property
    def places(self):
        """The x of the wheels' centres at static ride height, (2, stations) [m], left and right, front first."""
        return np.array([self.wheel_x, self.right_wheel_x or self.wheel_x])

    @model_validator(mode="after")
    def _from_front_to_rear(self):
        for name in ("wheel_x", "right_wheel_x"):
            x = getattr(self, name)
            if x is not None and (len(x) != self.stations or any(b >= a for a, b in zip(x, x[1:], strict=False))):
                raise ValueError(f"{name} is {x}, must be {self.stations} places, each behind the last")
        for name, values in self:
            if isinstance(values, list) and name not in ("centre", "inertia", "products", "wheel_x", "right_wheel_x"):
                check_stations(name, values, self.stations)
        return self

    @model_validator(mode="after")
    def _stop_within_reach(self):
        highest = self.length * (1.0 + sin(radians(self.static_angle)))
        if max(self.bump_travel) >= highest:
            raise ValueError(
                f"bump_travel is {max(self.bump_travel)} m, must be < {highest:.3f} m, which the arm can reach"
            )
        return self


class ShockAbsorbersParameters(Section):
    """Telescopic shock absorbers with blow-off, as seen at the wheel; none where the damping is zero."""

    damping: by_station("N s/m", ge=0.0)
    """Damping up to the blow-off force; 0 without an absorber."""
    blow_off_force: by_station("N", ge=0.0)
    """Force at which the valve opens."""
    blow_off_damping: by_station("N s/m", ge=0.0)
    """Damping beyond it."""


class RoadWheelsParameters(Section):
    """Road wheels, discs about their axle unless their inertia is given (about x, y and z)."""

    mass: Mass
    """Mass of one wheel."""
    radius: Length
    """Outer radius."""
    width: Length
    """Width, for the moments of inertia."""
    inertia: vector("kg m^2", 3, gt=0.0) | None = None
    """Moments of inertia about x, y and z; of a disc where left out."""
    y: Length
    """Distance of its middle from the middle of the vehicle."""
    bearing_damping: Gain("N m s/rad")
    """Damping of the bearing."""


class EndWheelsParameters(RoadWheelsParameters):
    """Sprockets or idlers: wheels that turn in the hull, one per side."""

    x: scalar("m")
    """Place of the axle along x."""
    z: scalar("m")
    """Height of the axle."""


class RollersParameters(RoadWheelsParameters):
    """Carrier rollers: wheels that turn in the hull, from front to rear."""

    x: vector("m", most=MOST_ROLLERS)
    """Places of the axles along x."""
    z: vector("m", most=MOST_ROLLERS)
    """Heights of the axles."""

    @model_validator(mode="after")
    def _x_and_z_pair(self):
        if len(self.x) != len(self.z):
            raise ValueError(f"x has {len(self.x)} places and z {len(self.z)}, must have equal numbers")
        return self


def at_stations(values, stations):
    """Return a quantity by station as an array (stations,)."""
    return np.broadcast_to(np.array(values), stations)


def check_stations(name, values, stations):
    """Raise `ValueError` unless a quantity by station has one value, or one for each."""
    if len(values) not in (1, stations):
        raise ValueError(f"{name} has {len(values)} values, must have one, or one for each of {stations} stations")
