"""How a powertrain is carried, as messages, bags and controllers know it: by which mounts, and how it can turn."""

from enum import IntEnum
from math import isfinite
from typing import NamedTuple

MOST_COILS, MOST_MOUNTS = 16, 32  # that a message can carry
_LONGEST_NAME = 64
_FARTHEST = 100.0  # m


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
        raise ValueError(f"{len(message.mounts)} mounts are described, accepted are at most {MOST_MOUNTS}")
    mounting = Mounting(tuple(map(_mount, message.mounts)), tuple(map(bool, message.turning)))
    if len(set(mounting.names)) < len(mounting.mounts):
        raise ValueError(f"mounts are called {', '.join(mounting.names)}, accepted are names that differ")
    if mounting.coils > MOST_COILS:
        raise ValueError(f"{mounting.coils} magnetorheological mounts are described, accepted are {MOST_COILS}")
    kinds = [mount.kind for mount in mounting.mounts]
    if kinds != sorted(kinds):
        raise ValueError("a rubber mount is described before a magnetorheological one, accepted is the reverse")
    return mounting


def _mount(message):
    name, place = message.name, (message.place.x, message.place.y, message.place.z)
    if not (0 < len(name) <= _LONGEST_NAME and name.isprintable()):
        raise ValueError(f"a mount is called {name[:_LONGEST_NAME]!r}, accepted are 1 to {_LONGEST_NAME} signs")
    if message.kind not in list(Kind):
        accepted = ", ".join(f"{kind} ({kind.name})" for kind in Kind)
        raise ValueError(f"mount {name} is of kind {message.kind}, accepted are {accepted}")
    if not all(isfinite(part) and abs(part) <= _FARTHEST for part in place):
        raise ValueError(f"mount {name} is at {place} m, accepted is up to {_FARTHEST:g} m each way")
    return Mount(name, Kind(message.kind), place)
