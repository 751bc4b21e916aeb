"""Parameters of engine, driveline and driver: their sections of a vehicle file."""

from itertools import pairwise

from pydantic import model_validator

from .quantities import scalar, vector, vectors
from .sections import Gain, Place, Range, Section, increasing

MOST_GEARS = 20


class EngineParameters(Section):
    """Excitation by engine order: force and moment amplitudes at rated speed."""

    rated_speed: scalar("r/min", gt=0.0)
    """Engine speed for which force and moment are given."""
    speed_range: Range("r/min")
    """Idle and highest engine speed."""
    place: Place
    """Point in the powertrain on which the forces act."""
    orders: vector("1/revolution", gt=0.0)
    """Engine orders, multiples of 0.5."""
    force: vectors("N", 3)
    """Amplitude of the force along x, y and z, a row for each order."""
    moment: vectors("N m", 3)
    """Amplitude of the moment about x, y and z, a row for each order."""
    phase: vector("rad")
    """Phase of each order."""
    imposed_amplitude: Gain("m")
    """Amplitude of the displacement of [Tao2025], if the run asks for it instead of forces."""

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
    """Engine speed over sprocket speed in each gear, first gear first."""
    shift_up: scalar("r/min", gt=0.0)
    """Engine speed at which the next gear is engaged."""
    shift_down: scalar("r/min", gt=0.0)
    """Engine speed at which the gear before is engaged."""
    curve_speed: vector("r/min", most=100, ge=0.0)
    """Engine speeds of the torque curve."""
    curve_torque: vector("N m", most=100, ge=0.0)
    """Torque at full load at these speeds."""
    efficiency: scalar("-", gt=0.0, le=1.0)
    """Power at the sprockets over that of the engine."""
    inertia: scalar("kg m^2", gt=0.0)
    """Moment of inertia of the engine at the crankshaft."""
    stiffness: scalar("N m/rad", gt=0.0)
    """Torsional stiffness of the shafts, at a sprocket."""
    damping: Gain("N m s/rad")
    """Torsional damping of the shafts, at a sprocket."""
    ripple: vector("N m", ge=0.0)
    """Amplitude of the engine's torque in each of its orders."""

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
    """Driving force for each m/s by which the vehicle is too slow."""
    speed_integral_gain: Gain("N/m")
    """Driving force for each metre by which it is behind."""
    force_limit: Gain("N")
    """Greatest driving or braking force."""
    heading_gain: Gain("N m/rad")
    """Turning moment for each radian off the heading of the path."""
    heading_damping: Gain("N m s/rad")
    """Turning moment against the yaw rate."""
    lane_gain: Gain("rad/m")
    """Change of the wanted heading for each metre off the path."""
    acceleration_limit: scalar("m/s^2", gt=0.0) | None = None
    """Greatest change of the wanted speed; 2 m/s^2 where left out."""
