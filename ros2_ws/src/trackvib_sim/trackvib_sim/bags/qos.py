"""Quality of service of a recorded topic, as rosbag2 of Jazzy (metadata version 9) writes it down."""

from ..numerics.units import NANO


def qos_record(profile):
    """Return one entry of `offered_qos_profiles` for an rclpy QoSProfile (or anything with its attributes)."""
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


def _time(duration):
    seconds, nanoseconds = divmod(duration.nanoseconds, NANO)
    return {"sec": seconds, "nsec": nanoseconds}
