"""The vehicle's parameters: what a vehicle file must hold."""

from math import radians, sin
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from .tracks.nodes import MOST_LINKS
from .quantities import scalar, vector, vectors

Mass = scalar("kg", gt=0.0)
Length = scalar("m", gt=0.0)
Place = vector("m", 3)
Inertia = vector("kg m^2", 3, gt=0.0)
Products = vector("kg m^2", 3)
Gain = lambda unit: scalar(unit, ge=0.0)  # noqa: E731 - reads as the type it stands for
Range = lambda unit: vector(unit, 2, ge=0.0)  # noqa: E731


class Section(BaseModel):
    """A section of the file: unknown items are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Solid(Section):
    """A rigid body: mass, centre from its origin, inertia about the centre (diagonal; products as matrix elements)."""

    mass: Mass
    centre: Place
    inertia: Inertia
    products: Products


class RotaryHinged(Solid):
    """A body on a revolute hinge with a rotary spring and damper."""

    place: Place
    stiffness: Gain("N m/rad")
    damping: Gain("N m s/rad")


class Sliding(Solid):
    """A body on a slide with a spring and damper."""

    place: Place
    stiffness: Gain("N/m")
    damping: Gain("N s/m")


class MrMounts(Section):
    """The pair of magnetorheological mounts: measured fits, their valid range, the other axes as ratios."""

    place: Place
    stiffness_fit: vector("kN/mm, I in A", 4)
    damping_ratio_fit: vector("-, I in A", 4)
    carried_mass: Mass
    static_load: Gain("N")
    current_range: Range("A")
    stiffness_ratio: vector("-", 2, ge=0.0)
    damping_ratio: vector("-", 2, ge=0.0)

    @model_validator(mode="after")
    def _stiff_over_the_range(self):
        stiffness = np.polyval(self.stiffness_fit, np.linspace(*self.current_range, 201))
        if stiffness.min() <= 0.0:
            raise ValueError(
                f"stiffness_fit falls to {stiffness.min():.3g} kN/mm within current_range, must stay > 0 there"
            )
        return self


class Coil(Section):
    """Driver and coil of one mount."""

    time_constant: scalar("s", gt=0.0)
    current_limits: Range("A")


class Engine(Section):
    """Excitation by engine order: force and moment amplitudes at rated speed."""

    rated_speed: scalar("r/min", gt=0.0)
    speed_range: Range("r/min")
    place: Place
    orders: vector("1/revolution", gt=0.0)
    force: vectors("N", 3)
    moment: vectors("N m", 3)
    phase: vector("rad")
    imposed_amplitude: Gain("m")

    @model_validator(mode="after")
    def _one_row_an_order(self):
        for name in ("force", "moment", "phase"):
            if len(getattr(self, name)) != len(self.orders):
                raise ValueError(f"{name} has {len(getattr(self, name))} rows, must have one for each order")
        if any(2.0 * order % 1.0 for order in self.orders):
            raise ValueError(f"orders are {self.orders}, must be multiples of 0.5 (a cycle takes two revolutions)")
        return self


class SwingArms(Solid):
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


class ShockAbsorbers(Section):
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


class RoadWheels(Section):
    """Road wheels as discs about their axle."""

    mass: Mass
    radius: Length
    width: Length
    y: Length
    bearing_damping: Gain("N m s/rad")


class Rims(Section):
    """Where wheels, rollers or idlers touch the links: radial contact, friction, sideways guidance."""

    radial_stiffness: scalar("N/m", gt=0.0)
    radial_damping: Gain("N s/m")
    friction: Gain("-")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")


class Tracks(Section):
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


class Ground(Section):
    """The ground under one shoe."""

    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    shear_stiffness: scalar("N/m", gt=0.0)
    shear_damping: Gain("N s/m")
    friction: scalar("-", gt=0.0)


class Teeth(Section):
    """Contact of the sprockets' teeth with the pins."""

    teeth: scalar("-", ge=6.0, le=40.0, multiple_of=1.0)
    pitch_excess: scalar("-", gt=-0.1, lt=0.1)
    flank_angle: scalar("deg", ge=0.0, le=60.0)
    backlash: Gain("m")
    height: Length
    stiffness: scalar("N/m", gt=0.0)
    damping: Gain("N s/m")
    guide_stiffness: Gain("N/m")
    guide_damping: Gain("N s/m")


class Tensioners(Section):
    """Slides that hold the idlers forwards."""

    stiffness: Gain("N/m")
    damping: Gain("N s/m")
    travel: Length


class HullWheels(Section):
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


class Driver(Section):
    """Keeps speed and lane."""

    speed_gain: Gain("N s/m")
    speed_integral_gain: Gain("N/m")
    force_limit: Gain("N")
    heading_gain: Gain("N m/rad")
    heading_damping: Gain("N m s/rad")
    lane_gain: Gain("rad/m")


class Vehicle(Section):
    """The whole file."""

    hull: Solid
    turret: RotaryHinged
    gun_mount: RotaryHinged
    recoil_part: Sliding
    powertrain: RotaryHinged
    mr_mounts: MrMounts
    coil: Coil
    engine: Engine
    swing_arms: SwingArms
    shock_absorbers: ShockAbsorbers
    road_wheels: RoadWheels
    tyres: Rims
    sprockets: HullWheels
    sprocket_teeth: Teeth
    carrier_rollers: HullWheels
    roller_rims: Rims
    idlers: HullWheels
    idler_rims: Rims
    tensioners: Tensioners
    tracks: Tracks
    ground: Ground
    driver: Driver

    @model_validator(mode="after")
    def _counts_of_the_paper(self):
        for name, count in (("sprockets", 1), ("carrier_rollers", 4), ("idlers", 1)):
            if len(getattr(self, name).x) != count:
                raise ValueError(f"{name}: {len(getattr(self, name).x)} places a side, must be {count}")
        for name, (low, high) in (
            ("mr_mounts.current_range", self.mr_mounts.current_range),
            ("coil.current_limits", self.coil.current_limits),
            ("engine.speed_range", self.engine.speed_range),
        ):
            if not low < high:
                raise ValueError(f"{name}: [{low}, {high}], the first must be below the second")
        return self
