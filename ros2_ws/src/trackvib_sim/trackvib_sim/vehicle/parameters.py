"""The vehicle's parameters: what a vehicle file must hold."""

import numpy as np
from pydantic import model_validator

from .quantities import choice, scalar, vector, vectors
from .running_gear_parameters import (
    GroundParameters,
    HullWheelsParameters,
    RimsParameters,
    RoadWheelsParameters,
    ShockAbsorbersParameters,
    SwingArmsParameters,
    TeethParameters,
    TensionersParameters,
    TracksParameters,
)
from .sections import Gain, Mass, Place, Range, RigidBodyParameters, Section


class RevoluteBodyParameters(RigidBodyParameters):
    """A body on a revolute hinge with a rotary spring and damper."""

    place: Place
    stiffness: Gain("N m/rad")
    damping: Gain("N m s/rad")


class PrismaticBodyParameters(RigidBodyParameters):
    """A body on a prismatic hinge with a spring and damper."""

    place: Place
    stiffness: Gain("N/m")
    damping: Gain("N s/m")


class MrMountsParameters(Section):
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


class CoilParameters(Section):
    """Driver and coil of one mount."""

    model: choice("lag", "current_loop")
    current_limits: Range("A")
    slew_rate: Gain("A/s")
    delay: scalar("s", ge=0.0, le=1.0)
    time_constant: scalar("s", gt=0.0)
    loop_time_constant: scalar("s", gt=0.0)
    voltage_limits: vector("V", 2)
    resistance: scalar("ohm", gt=0.0)
    inductance: scalar("H", gt=0.0)
    eddy_time_constant: Gain("s")

    @model_validator(mode="after")
    def _voltage_for_every_current(self):
        needed = [self.resistance * current for current in self.current_limits]
        if not (self.voltage_limits[0] <= needed[0] and needed[1] <= self.voltage_limits[1]):
            raise ValueError(
                f"voltage_limits are {self.voltage_limits} V, must hold {needed[0]:g} to {needed[1]:g} V, "
                "resistance times current_limits"
            )
        return self


class EngineParameters(Section):
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


class DriverParameters(Section):
    """Keeps speed and lane."""

    speed_gain: Gain("N s/m")
    speed_integral_gain: Gain("N/m")
    force_limit: Gain("N")
    heading_gain: Gain("N m/rad")
    heading_damping: Gain("N m s/rad")
    lane_gain: Gain("rad/m")


class Vehicle(Section):
    """The whole file.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, _ = tv.read_vehicle(tv.default_vehicle_file())
    >>> lighter = vehicle.model_copy(update={"hull": vehicle.hull.model_copy(update={"mass": 20_000.0})})
    >>> lighter.hull.mass  # kg
    20000.0
    """

    hull: RigidBodyParameters
    turret: RevoluteBodyParameters
    gun_mount: RevoluteBodyParameters
    recoil_part: PrismaticBodyParameters
    powertrain: RevoluteBodyParameters
    mr_mounts: MrMountsParameters
    coil: CoilParameters
    engine: EngineParameters
    swing_arms: SwingArmsParameters
    shock_absorbers: ShockAbsorbersParameters
    road_wheels: RoadWheelsParameters
    tyres: RimsParameters
    sprockets: HullWheelsParameters
    sprocket_teeth: TeethParameters
    carrier_rollers: HullWheelsParameters
    roller_rims: RimsParameters
    idlers: HullWheelsParameters
    idler_rims: RimsParameters
    tensioners: TensionersParameters
    tracks: TracksParameters
    ground: GroundParameters
    driver: DriverParameters

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
