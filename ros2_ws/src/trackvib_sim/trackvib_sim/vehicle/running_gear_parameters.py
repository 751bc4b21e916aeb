"""Parameters of suspension, wheels, tracks and ground: their sections of a vehicle file."""

from math import radians, sin
from typing import Annotated

from pydantic import Field, model_validator

from .quantities import scalar, vector
from .sections import Gain, Length, Mass, RigidBodyParameters, Section
from .tracks.nodes import MOST_LINKS


class SwingArmsParameters(RigidBodyParameters):
    """Swing arms with torsion bars and bump stops; stiffness and damping as seen at the wheel."""

    length: Length
    static_angle: scalar("deg", gt=0.0, lt=80.0)
    pivot_y: Length
    wheel_x: vector("m", 6)
    wheel_rate: scalar("N/m", gt=0.0)
    friction: Gain("N s/m")
    bump_travel: Length
    bump_stiffness: Gain("N/m")
    bump_damping: Gain("N s/m")

    @model_validator(mode="after")
    def _stop_within_reach(self):
        highest = self.length * (1.0 + sin(radians(self.static_angle)))
        if self.bump_travel >= highest:
            raise ValueError(f"bump_travel is {self.bump_travel} m, must be < {highest:.3f} m, which the arm can reach")
        return self


class ShockAbsorbersParameters(Section):
    """Telescopic shock absorbers with blow-off, as seen at the wheel."""

    stations: Annotated[vector("-", ge=1.0, le=6.0), Field(max_length=6)]
    damping: Gain("N s/m")
    blow_off_force: Gain("N")
    blow_off_damping: Gain("N s/m")

    @model_validator(mode="after")
    def _whole_stations(self):
        if any(station % 1.0 for station in self.stations):
            raise ValueError(f"stations is {self.stations}, must be whole numbers")
        return self


class RoadWheelsParameters(Section):
    """Road wheels as discs about their axle."""

    mass: Mass
    radius: Length
    width: Length
    y: Length
    bearing_damping: Gain("N m s/rad")


class HullWheelsParameters(Section):
    """Discs that turn in the hull: sprockets, carrier rollers, idlers."""

    mass: Mass
    radius: Length
    width: Length
    x: vector("m")
    y: Length
    z: vector("m")
    bearing_damping: Gain("N m s/rad")

    @model_validator(mode="after")
    def _x_and_z_pair(self):
        if len(self.x) != len(self.z):
            raise ValueError(f"x has {len(self.x)} places and z {len(self.z)}, must be as many")
        return self


class RimsParameters(Section):
    """Where wheels, rollers or idlers touch the links: radial contact, friction, sideways guidance."""

    radial_stiffness: scalar("N/m", gt=0.0)
    radial_damping: Gain("N s/m")
    friction: Gain("-")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")


class TeethParameters(Section):
    """Contact of the sprockets' teeth with the pins."""

    teeth: scalar("-", ge=6.0, le=40.0, multiple_of=1.0)
    pitch_excess: scalar("-", gt=-0.1, lt=0.1)
    flank_angle: scalar("deg", ge=0.0, le=60.0)
    backlash: Gain("m")
    height: Length
    corner_radius: Length
    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")


class TensionersParameters(Section):
    """Slides that hold the idlers forwards."""

    stiffness: Gain("N/m")
    damping: Gain("N s/m")
    travel: Length


class TracksParameters(Section):
    """Links and pins of both tracks."""

    links: scalar("-", ge=20.0, le=float(MOST_LINKS), multiple_of=1.0)
    pitch: Length
    shoe_mass: Mass
    link_stiffness: scalar("N/m", gt=0.0)
    link_damping: Gain("N s/m")
    pin_stiffness: Gain("N m/rad")
    pin_damping: Gain("N m s/rad")
    sideways_stiffness: Gain("N m/rad")
    pretension: Gain("N")


class GroundParameters(Section):
    """The ground under one shoe."""

    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    shear_stiffness: scalar("N/m", gt=0.0)
    shear_damping: Gain("N s/m")
    friction: scalar("-", gt=0.0)
