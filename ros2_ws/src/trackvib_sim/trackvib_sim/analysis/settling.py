"""How long a run settles before it is measured, and how long it is measured at least."""

SHORTEST_SETTLING = 2.0  # s
SHORTEST_MEASURING = 1.0  # s, after it
VEHICLE_BEHIND = 2.5  # m from the hull's origin to beyond the rear wheels


def settling_time(speed, full_roughness):
    """Return how long a run settles [s]: until the rear wheels are on the full roughness, at least 2 s.

    `speed` [m/s] is that of the vehicle, below zero backwards, `full_roughness` [m] the distance from which the road
    has all of it.
    """
    return max(SHORTEST_SETTLING, (full_roughness + VEHICLE_BEHIND) / abs(speed)) if speed else SHORTEST_SETTLING
