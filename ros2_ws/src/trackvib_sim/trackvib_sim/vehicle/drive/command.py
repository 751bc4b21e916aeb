"""Checks what somebody asks of the driver, as a command or in a schedule."""

from math import isfinite

from mr_mount_controller.node_base.plain_text import span

from .limits import FASTEST
from .path import HIGHEST_CURVATURE


def check_speed(speed):
    """Raise `ValueError` for a speed [m/s] that cannot be driven."""
    if not abs(speed) <= FASTEST:  # NaN is not either
        raise ValueError(f"speed is {speed} m/s, accepted: {span(-FASTEST, FASTEST, 'm/s')}")


def check_curvature(speed, curvature):
    """Raise `ValueError` for a curvature [1/m] that cannot be driven at a speed [m/s]."""
    if not abs(curvature) <= HIGHEST_CURVATURE:
        raise ValueError(
            f"curvature is {curvature:g} 1/m, accepted: {span(-HIGHEST_CURVATURE, HIGHEST_CURVATURE, '1/m')}: tighter "
            "turns are pivots, which are not modelled"
        )
    if curvature and speed < 0.0:
        raise ValueError(f"curvature is {curvature:g} 1/m at {speed:g} m/s, accepted in reverse is 0")


def curvature_of(speed, yaw_rate):
    """Return the curvature [1/m] of the path of a vehicle with a speed [m/s] and yaw rate [rad/s].

    Raises
    ------
    ValueError
        They cannot be driven.
    """
    check_speed(speed)
    if not isfinite(yaw_rate):
        raise ValueError(f"yaw rate is {yaw_rate} rad/s, must be finite")
    if yaw_rate == 0.0:
        return 0.0
    if speed == 0.0:
        raise ValueError(f"yaw rate is {yaw_rate:g} rad/s at 0 m/s, accepted: 0; turning on the spot is not modelled")
    check_curvature(speed, yaw_rate / speed)
    return yaw_rate / speed
