"""Drives the default vehicle over two obstacles of the M47's trials; prints what it does and draws obstacles.png.

./trackvib exec -- python docs/examples/obstacles.py
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import trackvib_sim as tv
from matplotlib import colormaps
from matplotlib.figure import Figure
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation
from trackvib_sim.road.feeder import RoadFeeder

FOLDER = Path(__file__).parent
ROADS = {"8-inch inverted V": "m47_ramp.yaml", "12-inch square bump": "m47_bump.yaml"}
SPEED = 20.0 * 0.3048  # m/s, of 20 ft/s
ENGINE_SPEED, TRACK_PHASE = 1650.0, 0.25  # r/min, part of a pitch; as `trackvib run` has them
BEGIN, END = 14.0, 38.0  # m, of the hull's origin; obstacles begin at 20 m
BEYOND = 2.0  # m, of a drive beyond its end, on which the filter settles
AHEAD = 50.0  # m of road
GRAVITY = 9.81  # m/s^2, which sensors read at rest
RIDE = 10.0  # Hz; above lie the blows of single links, which are not those of the obstacle


class Drive(NamedTuple):
    """A drive over an obstacle, a row a millisecond."""

    distance: np.ndarray  # (n,) of the hull's origin, m
    rise: np.ndarray  # (n,) of the hull's origin since the beginning, mm
    pitch: np.ndarray  # (n,) nose up, degrees
    speed: np.ndarray  # (n,) m/s
    acceleration: np.ndarray  # (n, 2) vertical, of chassis and powertrain, m/s^2
    ride: np.ndarray  # (n, 2) what of it lies below `RIDE`
    travel: np.ndarray  # (n, 6) of the left road wheels above static height, front to rear, mm


def drive(vehicle, road):
    """Return the `Drive` of a vehicle over a road."""
    settings = tv.RunSettings(tv.Operation(SPEED, ENGINE_SPEED, False, TRACK_PHASE), tv.Rates(), passive_current=1.0)
    simulation, rows, feeder = tv.Simulation(vehicle, settings), [], RoadFeeder(road, AHEAD)
    left = simulation.system.suspension.row[: vehicle.swing_arms.stations]
    while simulation.distance < END + BEYOND:
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        simulation.advance(np.ones(simulation.mounting.coils))
        tree, sample = simulation.state.tree, simulation.sample
        _, pitch, _ = Rotation.from_quat(tree.attitude[0], scalar_first=True).as_euler("ZYX", degrees=True)
        hull = simulation.distance, 1e3 * tree.position[0, 2], -pitch, sample.hull_velocity[0, 0]
        vertical, travel = sample.specific_force[:2, 2] - GRAVITY, wheel_rise(vehicle.swing_arms, tree.hinge[left])
        rows.append((*hull, *vertical, *travel))
    table = np.array(rows)
    ride = sosfiltfilt(butter(4, RIDE, fs=simulation.settings.rates.control, output="sos"), table[:, 4:6], axis=0)
    shown = (table[:, 0] >= BEGIN) & (table[:, 0] < END)
    table, ride = table[shown], ride[shown]
    table[:, 1] -= table[0, 1]
    return Drive(*table[:, :4].T, table[:, 4:6], ride, table[:, 6:])


def wheel_rise(arms, angle):
    """Return how far wheels are above their static height [mm] where their arms stand at angles [rad]."""
    static = np.radians(arms.static_angle)
    return 1e3 * arms.length * (np.sin(static) - np.sin(static - angle))


def told(run):
    """Return most and least of what a drive was, by its names."""
    chassis, powertrain = run.ride.T
    numbers = {
        "hull's pitch, nose up, degrees": run.pitch,
        "rise of the hull's origin, mm": run.rise,
        "speed, m/s": run.speed,
        f"chassis up, below {RIDE:g} Hz, m/s²": chassis,
        f"powertrain up, below {RIDE:g} Hz, m/s²": powertrain,
        "road wheels above static, mm": run.travel,
    }
    return {name: (values.max(), values.min()) for name, values in numbers.items()}


def draw(runs, stop, file):
    """Draw the drives side by side, with where the bump stops are [mm], to a PNG file."""
    figure = Figure(figsize=(13, 11), layout="constrained")
    plots = figure.subplots(4, len(runs), sharex=True, sharey="row")
    for column, (name, (road, run)) in zip(plots.T, runs.items(), strict=True):
        ground, hull, accelerations, wheels = column
        first, last = (round(place / road.spacing) for place in (BEGIN, END))
        place = road.spacing * np.arange(first, last)
        ground.set_title(f"{name} at {SPEED:.2f} m/s")
        ground.fill_between(place, -50.0, 1e3 * road.heights(first, last - first)[0], color="0.8")
        ground.plot(run.distance, run.rise, color="#3b6ea5", label="rise of the hull's origin")
        ground.set_ylabel("height, mm")
        hull.plot(run.distance, run.pitch, color="#3b6ea5", label="nose up")
        hull.set_ylabel("pitch, degrees")
        for k, (sensor, colour) in enumerate({"chassis": "#3b6ea5", "powertrain": "#d1662b"}.items()):
            accelerations.plot(run.distance, run.acceleration[:, k], color=colour, linewidth=0.4, alpha=0.25)
            accelerations.plot(run.distance, run.ride[:, k], color=colour, label=f"{sensor}, below {RIDE:g} Hz")
        accelerations.set_ylabel("vertical acceleration, m/s²")
        for k, travel in enumerate(run.travel.T):
            wheels.plot(run.distance, travel, color=colormaps["viridis"](k / 5), linewidth=1.0, label=f"{k + 1}")
        wheels.axhline(stop, color="0.4", linestyle=":", label="stop")
        wheels.set(ylabel="left road wheels, mm", xlabel="distance of the hull's origin, m", xlim=(BEGIN, END))
        for plot in column:
            plot.grid(alpha=0.3)
    for plot, columns in zip(plots[:, 0], (1, 1, 1, 7), strict=True):
        plot.legend(ncols=columns, fontsize=8, loc="upper right")
    figure.savefig(file, dpi=100)


def main():
    """Drive, tell and draw."""
    vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    runs = {}
    for name, file in ROADS.items():
        road = tv.find_road(str(FOLDER / file), 2.0 * vehicle.road_wheels.y)
        runs[name] = road, drive(vehicle, road)
    found = {name: told(run) for name, (_, run) in runs.items()}
    print(f"{'most and least':38}", *(f"{name:>20}" for name in found))
    for quantity in next(iter(found.values())):
        cells = (f"{most:9.2f} / {least:8.2f}" for most, least in (each[quantity] for each in found.values()))
        print(f"{quantity:38}", *(f"{cell:>20}" for cell in cells))
    (stop,) = set(vehicle.swing_arms.bump_travel)
    print(f"bump stops of the road wheels at {1e3 * stop:.1f} mm")
    draw(runs, 1e3 * stop, "obstacles.png")


if __name__ == "__main__":
    main()
