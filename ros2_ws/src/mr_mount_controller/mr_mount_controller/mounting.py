"""How a powertrain is carried, as messages, bags and controllers know it: by which mounts, and how it can turn."""

from enum import IntEnum
from math import isfinite, pi, sqrt
from typing import NamedTuple

from .mount import PUBLISHED, MountCurve
from .node_base.plain_text import number

MOST_COILS, MOST_MOUNTS = 16, 32  # that a message can carry
_LONGEST_NAME = 64
_FARTHEST = 100.0  # m
_LARGEST = 1e12  # of any number of what is carried, and of a curve
_LARGEST_CURRENT = 100.0  # A
_CHECKED = 100  # places of a curve at which its stiffness is looked at
_POSITIVE = ("hull_mass", "suspension_stiffness", "powertrain_mass", "pivot_inertia", "mount_mass")


class Kind(IntEnum):
    """What a mount is, by the numbers of `trackvib_msgs/Mount`."""

    MR = 0  # magnetorheological, with a coil
    RUBBER = 1


class Mount(NamedTuple):
    """One mount.

    Examples
    --------
    >>> from mr_mount_controller.mounting import Kind, Mount
    >>> Mount("left", Kind.MR, (0.0, 0.45, 0.0)).kind.name
    'MR'
    """

    name: str
    kind: Kind
    place: tuple  # (3,) of its lower (hull) end from the chassis sensor, hull axes, m


class Carried(NamedTuple):
    """What stands on the mounts, in the plane of the hull's x and z; `trackvib_msgs/Carried` says what is what.

    Examples
    --------
    >>> from mr_mount_controller.mounting import PAIR
    >>> round(PAIR.carried.resonance(2, PAIR.curve.stiffness(1.0)), 1)  # Hz
    5.9
    """

    hull_mass: float  # kg
    suspension_stiffness: float  # N/m
    suspension_damping: float  # N s/m
    powertrain_mass: float  # kg
    pivot_inertia: float  # kg m^2
    centre: tuple  # (2,) m
    sensor: tuple  # (2,) m
    coupling: float
    mount_mass: float  # kg
    other_stiffness: float  # N/m

    def resonance(self, mounts, stiffness):
        """Return the powertrain's natural frequency [Hz] on a number of mounts of a stiffness [N/m], hull held."""
        return sqrt((mounts * stiffness + self.other_stiffness) / self.mount_mass) / (2.0 * pi)


# the default vehicle, for a loop whose simulator does not tell
DEFAULT_CARRIED = Carried(
    hull_mass=30_300.0,
    suspension_stiffness=4.08e6,
    suspension_damping=1.98e5,
    powertrain_mass=3200.0,
    pivot_inertia=3073.12,
    centre=(0.55, 0.04),
    sensor=(0.80, -0.05),
    coupling=0.6875,
    mount_mass=4801.75,
    other_stiffness=312_500.0,
)


class Mounting(NamedTuple):
    """All mounts of a powertrain, the MR ones first, so that coil i is that of mount i.

    Examples
    --------
    >>> from mr_mount_controller.mounting import PAIR
    >>> PAIR.coils, PAIR.names
    (2, ('left', 'right'))
    """

    mounts: tuple  # of `Mount`
    turning: tuple = (True, True, True)  # about which axes x, y, z of the hull the powertrain can turn against it
    carried: Carried = DEFAULT_CARRIED
    curve: MountCurve = PUBLISHED  # of one MR mount

    @property
    def coils(self):
        """How many coils there are."""
        return sum(mount.kind == Kind.MR for mount in self.mounts)

    @property
    def names(self):
        """Names of all mounts; of the coils the first ones."""
        return tuple(mount.name for mount in self.mounts)


# [Tao2025]: the powertrain pitches on a hinge at its rear; both sensors sit between its two mounts
PAIR = Mounting(
    (Mount("left", Kind.MR, (0.0, 0.45, 0.0)), Mount("right", Kind.MR, (0.0, -0.45, 0.0))), (False, True, False)
)


def undescribed(coils, mounts=0):
    """Return the `Mounting` of so many coils, and mounts at least as many, of which nobody tells more.

    Two are the `PAIR`; others are called by their numbers, and taken to be where the sensors are.
    """
    mounts = max(coils, mounts)
    if coils == mounts == 2:
        return PAIR
    kinds = [Kind.MR] * coils + [Kind.RUBBER] * (mounts - coils)
    return Mounting(tuple(Mount(f"mount {k}", kind, (0.0, 0.0, 0.0)) for k, kind in enumerate(kinds, 1)))


def described(message):
    """Return the `Mounting` of a `trackvib_msgs/MountDescription`, whoever has read it.

    Raises
    ------
    ValueError
        It makes no sense; the message says what is wrong and what is accepted.
    """
    if len(message.mounts) > MOST_MOUNTS:
        raise ValueError(f"{len(message.mounts)} mounts are described, accepted: at most {MOST_MOUNTS}")
    told = {}
    if hasattr(message, "carried"):  # not in messages of former versions; all zero where a simulator does not tell
        if message.carried.powertrain_mass:
            told["carried"] = _carried(message.carried)
        if message.curve.carried_mass:
            told["curve"] = _curve(message.curve)
    mounting = Mounting(tuple(map(_mount, message.mounts)), tuple(map(bool, message.turning)), **told)
    if len(set(mounting.names)) < len(mounting.mounts):
        raise ValueError(f"mount names are {', '.join(mounting.names)}, must be unique")
    if mounting.coils > MOST_COILS:
        raise ValueError(f"{mounting.coils} magnetorheological mounts are described, accepted: {MOST_COILS}")
    kinds = [mount.kind for mount in mounting.mounts]
    if kinds != sorted(kinds):
        raise ValueError("a rubber mount is described before a magnetorheological one, must be after it")
    return mounting


def _carried(message):
    values = {name: getattr(message, name) for name in Carried._fields}
    for name, value in values.items():
        numbers = [float(number) for number in value] if name in ("centre", "sensor") else [float(value)]
        if not all(isfinite(number) and abs(number) <= _LARGEST for number in numbers):
            raise ValueError(f"carried.{name} is {value}, accepted: up to {number(_LARGEST)}")
        if name in _POSITIVE and not numbers[0] > 0.0:
            raise ValueError(f"carried.{name} is {value}, accepted: more than 0")
        values[name] = tuple(numbers) if len(numbers) > 1 else numbers[0]
    return Carried(**values)


def _curve(message):
    fits = [tuple(map(float, fit)) for fit in (message.stiffness_fit, message.damping_ratio_fit)]
    lowest, highest = map(float, message.current_range)
    rest = message.carried_mass, message.rubber_damping_ratio, lowest, highest, message.coil_lag
    curve = MountCurve(*fits, *map(float, rest))
    if not all(isfinite(number) and abs(number) <= _LARGEST for number in (*fits[0], *fits[1], *curve[2:])):
        raise ValueError(f"curve is {curve}, accepted: numbers up to {number(_LARGEST)}")
    if not (0.0 <= lowest < highest <= _LARGEST_CURRENT and curve.carried_mass > 0.0 and curve.coil_lag >= 0.0):
        raise ValueError(f"curve has the currents {lowest:g} to {highest:g} A, accepted: 0 to {_LARGEST_CURRENT:g}")
    if not all(curve.stiffness(highest * n / _CHECKED) > 0.0 for n in range(_CHECKED + 1)):
        raise ValueError(f"curve has no stiffness somewhere up to {highest:g} A, accepted: more than 0")
    return curve


def _mount(message):
    name, place = message.name, (message.place.x, message.place.y, message.place.z)
    if not (0 < len(name) <= _LONGEST_NAME and name.isprintable()):
        raise ValueError(f"a mount is called {name[:_LONGEST_NAME]!r}, accepted: 1 to {_LONGEST_NAME} characters")
    if message.kind not in list(Kind):
        accepted = ", ".join(f"{kind} ({kind.name})" for kind in Kind)
        raise ValueError(f"mount {name} is of kind {message.kind}, accepted: {accepted}")
    if not all(isfinite(part) and abs(part) <= _FARTHEST for part in place):
        raise ValueError(f"mount {name} is at {place} m, accepted: up to {_FARTHEST:g} m each way")
    return Mount(name, Kind(message.kind), place)
