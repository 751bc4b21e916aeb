"""Parameters of suspension, wheels, tracks and ground: their sections of a vehicle file.

A quantity by station is one number for all stations of both sides, or a list from the front station to the rear one.
One by side is one number for both, or a pair, left and right.
"""

from math import radians, sin
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, model_validator

from .quantities import one_or_many, scalar, vector, words
from .sections import Gain, Length, Mass, RigidBodyParameters, Section
from .tracks.nodes import FEWEST_LINKS, MOST_LINKS

MOST_STATIONS = 12
MOST_ROLLERS = 12
MOST_CONTACTS = 4  # of a link with a sprocket
SIDES = 2
LONGEST_SHEAR = 0.02  # s, of the ground's damping to its stiffness

by_station = lambda unit, **limits: one_or_many(unit, MOST_STATIONS, **limits)  # noqa: E731 - read as types
by_side = lambda unit, **limits: Annotated[one_or_many(unit, SIDES, **limits), AfterValidator(_pair)]  # noqa: E731


def _pair(values):
    return values if len(values) == SIDES else values * SIDES


class SwingArmsParameters(RigidBodyParameters):
    """Swing arms with torsion bars and bump stops; stiffness and damping as seen at the wheel.

    Mass and inertia are those of the left trailing arm, from its pivot; others mirror it.
    """

    length: Length
    static_angle: scalar("deg", gt=-80.0, lt=80.0)
    direction: words(MOST_STATIONS, "trailing", "leading")
    pivot_y: Length
    wheel_x: vector("m", most=MOST_STATIONS)
    right_wheel_x: vector("m", most=MOST_STATIONS) | None = None
    wheel_rate: by_station("N/m", gt=0.0)
    preload: by_station("N m", ge=0.0) | None = None
    friction: by_station("N s/m", ge=0.0)
    bump_travel: by_station("m", gt=0.0)
    bump_stiffness: by_station("N/m", ge=0.0)
    bump_damping: by_station("N s/m", ge=0.0)

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
    blow_off_force: by_station("N", ge=0.0)
    blow_off_damping: by_station("N s/m", ge=0.0)


class RoadWheelsParameters(Section):
    """Road wheels, discs about their axle unless their inertia is given (about x, y and z)."""

    mass: Mass
    radius: Length
    width: Length
    inertia: vector("kg m^2", 3, gt=0.0) | None = None
    y: Length
    bearing_damping: Gain("N m s/rad")


class EndWheelsParameters(RoadWheelsParameters):
    """Sprockets or idlers: wheels that turn in the hull, one per side."""

    x: scalar("m")
    z: scalar("m")


class RollersParameters(RoadWheelsParameters):
    """Carrier rollers: wheels that turn in the hull, from front to rear."""

    x: vector("m", most=MOST_ROLLERS)
    z: vector("m", most=MOST_ROLLERS)

    @model_validator(mode="after")
    def _x_and_z_pair(self):
        if len(self.x) != len(self.z):
            raise ValueError(f"x has {len(self.x)} places and z {len(self.z)}, must have equal numbers")
        return self


class RimsParameters(Section):
    """Where wheels, rollers or idlers touch the links: radial contact, friction, sideways guidance."""

    radial_stiffness: scalar("N/m", gt=0.0)
    radial_damping: Gain("N s/m")
    friction: Gain("-")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")


class TeethParameters(Section):
    """Contact of the sprockets' teeth with the pins, or with what else of a shoe touches them.

    Seat and flanks are straight, or one concave arc: `arc_centre` is then the distance of its centre from the hub, and
    `arc_radius` its radius as the pins' centres see it. `contacts` are the places along a link, from its middle on,
    forwards on the lower run; without them the pins touch.
    """

    teeth: scalar("-", ge=6.0, le=40.0, multiple_of=1.0)
    pitch_excess: scalar("-", gt=-0.1, lt=0.1)
    flank_angle: scalar("deg", ge=0.0, le=60.0)
    backlash: Gain("m")
    height: Length
    corner_radius: Length
    arc_centre: Length | None = None
    arc_radius: Length | None = None
    contacts: vector("m", most=MOST_CONTACTS) | None = None
    friction: Gain("-") | None = None
    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")

    @model_validator(mode="after")
    def _whole_arc(self):
        if (self.arc_centre is None) != (self.arc_radius is None):
            raise ValueError("arc_centre and arc_radius: must be given both or neither")
        if self.arc_centre is not None and not self.arc_radius < self.arc_centre:
            raise ValueError(f"arc_radius is {self.arc_radius} m, must be less than arc_centre, {self.arc_centre} m")
        return self


class TensionersParameters(Section):
    """Slides that hold the idlers outwards.

    `force` is that of their springs with the idlers at their places; without it, it is what gives the taut tracks
    their pretension.
    """

    stiffness: Gain("N/m")
    damping: Gain("N s/m")
    force: by_side("N", ge=0.0) | None = None
    travel: Length


class TracksParameters(Section):
    """Links and pins of both tracks."""

    links: by_side("-", ge=float(FEWEST_LINKS), le=float(MOST_LINKS), multiple_of=1.0)
    pitch: Length
    shoe_mass: Mass
    link_stiffness: scalar("N/m", gt=0.0)
    link_damping: Gain("N s/m")
    pin_stiffness: Gain("N m/rad")
    pin_damping: Gain("N m s/rad")
    sideways_stiffness: Gain("N m/rad")
    pretension: by_side("N", ge=0.0)


class GroundParameters(Section):
    """The ground under one shoe. Without `shear_stiffness` it is viscous up to Coulomb's limit and keeps no shear."""

    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    shear_stiffness: Gain("N/m")
    shear_damping: Gain("N s/m")
    friction: scalar("-", gt=0.0)

    @model_validator(mode="after")
    def _short_shear(self):
        # the spring of a sliding shoe is drawn to where spring and damper together give friction: by about speed times
        # this time, which must stay far below a shoe's length
        if self.shear_stiffness > 0.0 and self.shear_damping > LONGEST_SHEAR * self.shear_stiffness:
            raise ValueError(
                f"shear_damping / shear_stiffness is {self.shear_damping / self.shear_stiffness:.3g} s, "
                f"must be at most {LONGEST_SHEAR:g} s, or shear_stiffness 0"
            )
        return self


def at_stations(values, stations):
    """Return a quantity by station as an array (stations,)."""
    return np.broadcast_to(np.array(values), stations)


def check_stations(name, values, stations):
    """Raise `ValueError` unless a quantity by station has one value, or one for each."""
    if len(values) not in (1, stations):
        raise ValueError(f"{name} has {len(values)} values, must have one, or one for each of {stations} stations")
