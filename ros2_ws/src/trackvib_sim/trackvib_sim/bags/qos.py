"""Quality of service of a recorded topic, as rosbag2 of Jazzy (metadata version 9) writes it down."""


def qos_record(depth, reliability, durability):
    """Return one entry of `offered_qos_profiles`; the names are those of rmw in lower case."""
    endless = {"sec": 9223372036, "nsec": 854775807}
    return {
        "history": "keep_last",
        "depth": depth,
        "reliability": reliability,
        "durability": durability,
        "deadline": endless,
        "lifespan": endless,
        "liveliness": "automatic",
        "liveliness_lease_duration": endless,
        "avoid_ros_namespace_conventions": False,
    }
