"""The vehicle's parameters: what a vehicle file must hold."""

from math import sqrt
from typing import Annotated, Literal

from mr_mount_controller.mounting import MOST_COILS, MOST_MOUNTS
from mr_mount_controller.node_base.plain_text import number
from pydantic import Field, model_validator

from .body_parameters import HULL, AnyBodyParameters
from .drive_parameters import DrivelineParameters, DriverParameters, EngineParameters
from .mount_parameters import AnyMountKind, CoilParameters, MountParameters
from .quantities import scalar, vector
from .running_gear_parameters import (
    EndWheelsParameters,
    RoadWheelsParameters,
    RollersParameters,
    ShockAbsorbersParameters,
    SwingArmsParameters,
    check_stations,
)
from .sections import Angles, Name, Place, RigidBodyParameters, Section
from .track_parameters import (
    GroundParameters,
    RimsParameters,
    TeethParameters,
    TensionersParameters,
    TracksParameters,
)
from .upgrade import FORMAT, upgraded

POWERTRAIN = "powertrain"
CHASSIS = "chassis"
MOST_BODIES = 30
MOST_SENSORS = 32


class SensorParameters(Section):
    """An inertial sensor; `divisor` control periods make one of its samples. Errors of the accelerometer, and of the
    gyroscope (`rate_`): what is left out is ideal."""

    body: Name
    """Body to which it is fixed."""
    place: Place
    """Place in the body's axes."""
    orientation: Angles | None = None
    """Roll, pitch and yaw of the sensor in the body; along its axes where left out."""
    divisor: scalar("-", ge=1.0, le=1000.0, multiple_of=1.0) | None = None
    """Control periods for each sample; 1 where left out."""
    bandwidth: scalar("Hz", gt=0.0) | None = None
    """Cut-off frequency of its low-pass; by its sampling rate where left out."""
    noise: scalar("m/s^2/sqrt(Hz)", ge=0.0) | None = None
    """Noise density of the accelerometer."""
    bias: vector("m/s^2", 3) | None = None
    """Offset of the accelerometer along x, y and z."""
    range: scalar("m/s^2", gt=0.0) | None = None
    """Greatest acceleration that it measures, either way."""
    resolution: scalar("m/s^2", gt=0.0) | None = None
    """Step of the accelerometer's digits."""
    rate_noise: scalar("rad/s/sqrt(Hz)", ge=0.0) | None = None
    """Noise density of the gyroscope."""
    rate_bias: vector("rad/s", 3) | None = None
    """Offset of the gyroscope about x, y and z."""
    rate_range: scalar("rad/s", gt=0.0) | None = None
    """Greatest angular velocity that it measures, either way."""
    rate_resolution: scalar("rad/s", gt=0.0) | None = None
    """Step of the gyroscope's digits."""


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
    """Version of the file's format."""
    name: Name
    """Name of the vehicle."""
    description: Annotated[str, Field(max_length=500)]
    """The vehicle in one sentence."""
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
    def _bodies_within_reach(self):
        """A radius of gyration is at most half of a body's length; none is twice as long as its tracks."""
        longest = abs(self.sprockets.x - self.idlers.x)
        for name, body in ((HULL, self.hull), *self.bodies.items(), (POWERTRAIN, self.powertrain)):
            gyration = sqrt(max(body.inertia) / body.mass)
            if gyration > longest:
                raise ValueError(
                    f"{name}: mass is {number(body.mass)} kg and inertia {body.inertia} kg m^2, a radius of gyration "
                    f"of {gyration:.3g} m, must be at most {longest:.3g} m, the distance from sprockets to idlers"
                )
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
