"""Quality of service of a recorded topic, as rosbag2 writes it down."""

from typing import NamedTuple

from ..numerics.units import NANO
from ..yaml_text import YamlTextError, load

RELIABLE, BEST_EFFORT = "reliable", "best_effort"
VOLATILE, TRANSIENT_LOCAL = "volatile", "transient_local"
# versions of rosbag2 before Jazzy write the numbers of rmw's enumerations; 0 is the system's default
_RELIABILITY = {1: RELIABLE, 2: BEST_EFFORT}
_DURABILITY = {1: TRANSIENT_LOCAL, 2: VOLATILE}


class Offer(NamedTuple):
    """What a publisher offered."""

    reliability: str
    durability: str


def qos_record(profile):
    """Return one entry of `offered_qos_profiles` for an rclpy QoSProfile (or anything with its attributes).

    It is as in Jazzy (metadata version 9).
    """
    return {
        "history": profile.history.name.lower(),
        "depth": profile.depth,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "deadline": _time(profile.deadline),
        "lifespan": _time(profile.lifespan),
        "liveliness": profile.liveliness.name.lower(),
        "liveliness_lease_duration": _time(profile.liveliness_lease_duration),
        "avoid_ros_namespace_conventions": profile.avoid_ros_namespace_conventions,
    }


def declared_qos(channel):
    """Return the list of QoS entries that an MCAP channel declares, as they stand; empty where it is no readable one.

    Of other tools it may be anything.
    """
    try:
        declared = load(channel.metadata.get("offered_qos_profiles", ""), f"QoS of {channel.topic}")
    except YamlTextError:
        return []
    return declared if isinstance(declared, list) else []


def offers(channel):
    """Return the `Offer`s that an MCAP channel declares, by any rosbag2; what is missing is as ROS does by default."""
    return [
        Offer(
            _word(entry.get("reliability"), _RELIABILITY, RELIABLE),
            _word(entry.get("durability"), _DURABILITY, VOLATILE),
        )
        for entry in declared_qos(channel)
        if isinstance(entry, dict)
    ]


def _word(value, words, default):
    if isinstance(value, str):
        return value if value in words.values() else default
    return words.get(value, default) if isinstance(value, int) else default


def _time(duration):
    seconds, nanoseconds = divmod(duration.nanoseconds, NANO)
    return {"sec": seconds, "nsec": nanoseconds}
