"""Lines of the spectrum with a known cause: links entering the sprockets, orders of the engine."""

from math import isnan

import numpy as np

from ..bags.provenance import parameters_with
from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle
from .numbers import AXES, SENSORS, Line

HALF_WIDTH = 2.0  # Hz, to either side of a line: what a Hann window spreads a sine over, rounded up
HARMONICS = 3  # of link passing


def find_lines(recording, spectra, speed, speed_deviation):
    """Return the engine's speed [r/min], the `Line`s of a recording, and notes on why there are fewer.

    `speed` and its deviation are those of the hull over the measured time [m/s]; nan if unknown.
    """
    notes, parameters = [], parameters_with(recording.provenance, "engine_speed")[1]
    engine_speed = float(parameters.get("engine_speed", "nan"))
    if isnan(speed):
        where = "in the bag" if recording.odometry is None else "after the settling time"
        notes.append(f"no odometry {where}: no speed, no levels of link passing")
    if isnan(engine_speed):
        notes.append("the bag does not tell the engine's speed: no levels of its orders")
    try:
        vehicle = parse_vehicle(recording.vehicle or "", "vehicle description in the bag")
    except VehicleFileError as error:
        reason = str(error).splitlines()[0] if recording.vehicle else "no vehicle description in the bag"
        return engine_speed, (), [*notes, f"{reason}: no levels of link passing and engine orders"]
    lines = known_lines(spectra, speed, speed_deviation, vehicle.tracks.pitch, engine_speed, vehicle.engine.orders)
    return engine_speed, lines, notes


def known_lines(spectra, speed, speed_deviation, pitch, engine_speed, orders):
    """Return the `Line`s of links entering the sprockets and of the engine that lie within the spectra.

    Parameters
    ----------
    spectra : Spectra
    speed, speed_deviation : float
        Of the hull, m/s. The band about a line of link passing is wider by two deviations.
    pitch : float
        Of the tracks, m.
    engine_speed : float
        r/min
    orders : sequence of float
        Of the engine, cycles a revolution.
    """
    passing, turning = abs(speed) / pitch, engine_speed / 60.0
    wanted = [
        (f"link passing {n}", n * passing, HALF_WIDTH + 2.0 * n * speed_deviation / pitch)
        for n in range(1, HARMONICS + 1)
    ]
    wanted += [(f"engine order {order:g}", order * turning, HALF_WIDTH) for order in orders]
    highest = spectra.frequency[-1]
    return tuple(
        Line(name, frequency, max(frequency - half, 0.0), frequency + half, _in_band(spectra, frequency, half))
        for name, frequency, half in wanted
        if HALF_WIDTH < frequency <= highest - HALF_WIDTH  # false for nan
    )


def _in_band(spectra, frequency, half):
    inside = np.abs(spectra.frequency - frequency) <= half
    resolution = spectra.frequency[1]
    return {
        sensor: dict(zip(AXES, np.sqrt(spectra.psd[sensor][inside].sum(axis=0) * resolution).tolist(), strict=True))
        for sensor in SENSORS
    }
