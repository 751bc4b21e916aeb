"""The headline numbers of one run."""

from math import isfinite


def summarise(analysis):
    """Return the summary of a run, of its `numbers.Analysis`, as a dict of plain values, ready for JSON."""
    return {
        "band_hz": list(analysis.band),
        "settled_after_s": analysis.settle,
        "rms_mps2": {
            sensor: {axis: numbers.rms for axis, numbers in axes.items()} for sensor, axes in analysis.sensors.items()
        },
        "absorbed_power_W": {sensor: _number(power) for sensor, power in analysis.absorbed_power.items()},
        "drive_N": _number(analysis.drive_force),
        "drive_W": _number(analysis.drive_power),
        "mounts_J": analysis.mount_energy,
        "loop": analysis.loop,
        "messages": analysis.messages,
    }


def _number(value):
    return value if isfinite(value) else None
