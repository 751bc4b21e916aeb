"""What a run is made of, validated once."""

from dataclasses import dataclass

from ..numerics.units import NANO
from ..vehicle.system import Operation


@dataclass(frozen=True)
class Rates:
    """Whole rates [Hz] that divide each other, so that every event falls on an exact nanosecond.

    The physics rate is by default twice that which the included vehicles need, see `vehicle.step_size`.

    Raises
    ------
    ValueError
        They do not.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Rates(physics=10_000, control=1_000).steps
    10
    """

    physics: int = 10_000
    control: int = 1_000
    odometry: int = 100

    def __post_init__(self):
        pairs = (("physics_rate", "control_rate"), ("control_rate", "odometry_rate"))
        for fast, slow in pairs:
            f, s = getattr(self, fast.removesuffix("_rate")), getattr(self, slow.removesuffix("_rate"))
            if f % s:
                raise ValueError(
                    f"{fast} {f} Hz and {slow} {s} Hz conflict: the first must be a multiple of the second"
                )
        if NANO % self.physics:
            raise ValueError(f"physics_rate {self.physics} Hz does not divide a second into whole nanoseconds")

    @property
    def steps(self) -> int:
        """Physics steps in a control period."""
        return self.physics // self.control

    @property
    def period(self) -> int:
        """Control period [ns]."""
        return NANO // self.control


@dataclass(frozen=True)
class RunSettings:
    """How the vehicle is driven and at which rates it is stepped and measured.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    >>> settings.rates.period  # ns
    1000000
    """

    operation: Operation
    rates: Rates
    passive_current: float  # A, in the coils before the first answer
