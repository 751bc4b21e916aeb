"""The vehicle's parameters: what a vehicle file must hold."""

from itertools import pairwise
from typing import Annotated, Literal

from mr_mount_controller.mounting import MOST_COILS, MOST_MOUNTS
from pydantic import Field, model_validator

from .body_parameters import HULL, AnyBodyParameters
from .mount_parameters import AnyMountKind, CoilParameters, MountParameters
from .quantities import scalar, vector, vectors
from .running_gear_parameters import (
    EndWheelsParameters,
    GroundParameters,
    RimsParameters,
    RoadWheelsParameters,
    RollersParameters,
    ShockAbsorbersParameters,
    SwingArmsParameters,
    TeethParameters,
    TensionersParameters,
    TracksParameters,
    check_stations,
)
from .sections import Angles, Gain, Name, Place, Range, RigidBodyParameters, Section, increasing
from .upgrade import FORMAT, upgraded

POWERTRAIN = "powertrain"
CHASSIS = "chassis"
MOST_BODIES = 30
MOST_GEARS = 20
MOST_SENSORS = 32


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
        increasing("speed_range", self.speed_range)
        for name in ("force", "moment", "phase"):
            if len(getattr(self, name)) != len(self.orders):
                raise ValueError(f"{name} has {len(getattr(self, name))} rows, must have one for each order")
        if any(2.0 * order % 1.0 for order in self.orders):
            raise ValueError(f"orders are {self.orders}, must be multiples of 0.5 (a cycle takes two revolutions)")
        return self


class DrivelineParameters(Section):
    """Gears between the crankshaft and the sprockets, the engine's torque at full load, and the shafts."""

    ratios: vector("-", most=MOST_GEARS, gt=0.0)
    shift_up: scalar("r/min", gt=0.0)
    shift_down: scalar("r/min", gt=0.0)
    curve_speed: vector("r/min", most=100, ge=0.0)
    curve_torque: vector("N m", most=100, ge=0.0)
    efficiency: scalar("-", gt=0.0, le=1.0)
    inertia: scalar("kg m^2", gt=0.0)
    stiffness: scalar("N m/rad", gt=0.0)
    damping: Gain("N m s/rad")
    ripple: vector("N m", ge=0.0)

    @model_validator(mode="after")
    def _gears_and_curve(self):
        if any(low <= high for low, high in pairwise(self.ratios)):
            raise ValueError(f"ratios are {self.ratios}, each must be below the one before")
        if len(self.curve_speed) < 2 or len(self.curve_speed) != len(self.curve_torque):
            raise ValueError(
                f"curve_speed has {len(self.curve_speed)} numbers and curve_torque {len(self.curve_torque)}, must "
                "have equal numbers, at least 2"
            )
        if any(high <= low for low, high in pairwise(self.curve_speed)):
            raise ValueError(f"curve_speed is {self.curve_speed}, each must be above the one before")
        for low, high in pairwise(self.ratios):
            if self.shift_down >= self.shift_up * high / low:
                raise ValueError(
                    f"shift_down is {self.shift_down:g} r/min, must be below {self.shift_up * high / low:g} r/min, to "
                    f"which shifting up from ratio {low:g} to {high:g} leads"
                )
        return self


class DriverParameters(Section):
    """Keeps speed and path."""

    speed_gain: Gain("N s/m")
    speed_integral_gain: Gain("N/m")
    force_limit: Gain("N")
    heading_gain: Gain("N m/rad")
    heading_damping: Gain("N m s/rad")
    lane_gain: Gain("rad/m")
    acceleration_limit: scalar("m/s^2", gt=0.0) | None = None


class SensorParameters(Section):
    """An inertial sensor; `divisor` control periods make one of its samples. Errors of the accelerometer, and of the
    gyroscope (`rate_`): what is left out is ideal."""

    body: Name
    place: Place
    orientation: Angles | None = None
    divisor: scalar("-", ge=1.0, le=1000.0, multiple_of=1.0) | None = None
    bandwidth: scalar("Hz", gt=0.0) | None = None
    noise: scalar("m/s^2/sqrt(Hz)", ge=0.0) | None = None
    bias: vector("m/s^2", 3) | None = None
    range: scalar("m/s^2", gt=0.0) | None = None
    resolution: scalar("m/s^2", gt=0.0) | None = None
    rate_noise: scalar("rad/s/sqrt(Hz)", ge=0.0) | None = None
    rate_bias: vector("rad/s", 3) | None = None
    rate_range: scalar("rad/s", gt=0.0) | None = None
    rate_resolution: scalar("rad/s", gt=0.0) | None = None


class Vehicle(Section):
    """A whole vehicle file.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    >>> lighter = vehicle.model_copy(update={"hull": vehicle.hull.model_copy(update={"mass": 20_000.0})})
    >>> lighter.hull.mass  # kg
    20000.0
    """

    format: Literal[FORMAT]
    name: Name
    description: Annotated[str, Field(max_length=500)]
    hull: RigidBodyParameters
    bodies: Annotated[dict[Name, AnyBodyParameters], Field(max_length=MOST_BODIES)] = {}
    powertrain: AnyBodyParameters
    mount_types: dict[Name, AnyMountKind] = {}
    mounts: Annotated[dict[Name, MountParameters], Field(max_length=MOST_MOUNTS)] = {}
    coil: CoilParameters
    engine: EngineParameters
    sensors: Annotated[dict[Name, SensorParameters], Field(max_length=MOST_SENSORS)] = {}
    swing_arms: SwingArmsParameters
    shock_absorbers: ShockAbsorbersParameters
    road_wheels: RoadWheelsParameters
    tyres: RimsParameters
    sprockets: EndWheelsParameters
    sprocket_teeth: TeethParameters
    carrier_rollers: RollersParameters | None = None
    roller_rims: RimsParameters | None = None
    idlers: EndWheelsParameters
    idler_rims: RimsParameters
    tensioners: TensionersParameters
    tracks: TracksParameters
    ground: GroundParameters
    driver: DriverParameters
    driveline: DrivelineParameters | None = None

    @model_validator(mode="before")
    @classmethod
    def _of_the_present_format(cls, content):
        return upgraded(content)

    @model_validator(mode="after")
    def _bodies_in_order(self):
        known = [HULL]
        for name, body in (*self.bodies.items(), (POWERTRAIN, self.powertrain)):
            if name in known or name.startswith(("left_", "right_")) or name == CHASSIS:
                raise ValueError(
                    f"bodies.{name}: the name is already used; those of the running gear begin with a side"
                )
            if body.parent not in known:
                raise ValueError(
                    f"bodies.{name}: parent is {body.parent!r}, must stand before it; known are {', '.join(known)}"
                )
            known.append(name)
        for name, sensor in self.sensors.items():
            if sensor.body not in known:
                raise ValueError(f"sensors.{name}: body is {sensor.body!r}, must be one of {', '.join(known)}")
            if name in (CHASSIS, POWERTRAIN) and sensor.divisor not in (None, 1.0):
                raise ValueError(f"sensors.{name}: divisor is {sensor.divisor:g}, must be 1, for controllers")
        return self

    @model_validator(mode="after")
    def _mounts_hold_bodies(self):
        bodies = {**self.bodies, POWERTRAIN: self.powertrain}
        for name, mount in self.mounts.items():
            for item, value, known in (("type", mount.type, self.mount_types), ("body", mount.body, bodies)):
                if value not in known:
                    raise ValueError(f"mounts.{name}: {item} is {value!r}, must be one of {', '.join(known) or 'none'}")
        coils = sum(self.mount_types[mount.type].kind == "mr" for mount in self.mounts.values())
        if coils > MOST_COILS:
            raise ValueError(f"mounts: {coils} are of kind 'mr', accepted: {MOST_COILS}")
        held = {mount.body for mount in self.mounts.values()}
        for name, body in bodies.items():
            if body.hinge == "free" and name not in held:
                raise ValueError(f"{name}: hinge is 'free', so mounts must hold it")
        if not any(mount.body == POWERTRAIN for mount in self.mounts.values()):
            for sensor in (CHASSIS, POWERTRAIN):
                if sensor not in self.sensors:
                    raise ValueError(f"sensors.{sensor}: must be given, for no mount carries the powertrain")
        return self

    @model_validator(mode="after")
    def _driveline_fits_engine(self):
        if self.driveline is not None and len(self.driveline.ripple) != len(self.engine.orders):
            raise ValueError(
                f"driveline.ripple has {len(self.driveline.ripple)} numbers, must have one for each of the engine's "
                f"{len(self.engine.orders)} orders"
            )
        return self

    @model_validator(mode="after")
    def _running_gear_fits_together(self):
        arms, shocks = self.swing_arms, self.shock_absorbers
        for name, values in shocks:
            check_stations(f"shock_absorbers.{name}", values, arms.stations)
        if (self.carrier_rollers is None) != (self.roller_rims is None):
            raise ValueError("carrier_rollers and roller_rims: must be given both or neither")
        rear, front = sorted((self.sprockets.x, self.idlers.x))
        if not rear < arms.places.min() <= arms.places.max() < front:
            raise ValueError(
                f"sprockets.x is {self.sprockets.x:g} m and idlers.x {self.idlers.x:g} m, the road wheels must lie "
                f"between them, they are at {arms.places.min():g} to {arms.places.max():g} m"
            )
        return self
