"""Drives the default vehicle as the field test of [Tao2025] did, as far as that is told; prints it beside the test.

./trackvib exec -- python docs/examples/field_test.py
"""

from typing import NamedTuple

import numpy as np
import trackvib_sim as tv
from matplotlib.figure import Figure
from trackvib_sim.analysis.vibration import band_limited, psd, rms

LINES = {"chassis": 74.07, "powertrain": 69.18}  # Hz, main peaks of the test, its Figure 14
REDUCTIONS = {"z": 29.98, "y": 35.17, "x": -4.75}  # per cent, of the test, by our axes
AXES = ("x", "y", "z")
ENGINE_SPEED = 1650.0  # r/min; that of the test is not told
ROAD_CLASS, SEEDS = "E", (1, 2, 3, 4)  # the road of the test is not told either; lines vary from one to the next
SETTLING, MEASURING = 5.0, 10.0  # s, on each
RELATIVE_SPEEDS = (0.4, 0.6, 0.8, 1.0, 1.2)  # of the one at which links pass at the chassis's line
NEAR = 60.0, 85.0  # Hz, in which the main peak is looked for beside the test's


class Drive(NamedTuple):
    """Steady drives at a speed: levels by sensor and axis, spectra of the vertical; quadratic means over the roads."""

    speed: float  # m/s
    rms: dict  # sensor -> (3,) m/s^2, 0.5 to 500 Hz
    frequency: np.ndarray  # (f,) Hz
    density: dict  # sensor -> (f,) (m/s^2)^2/Hz


def drive(vehicle, speed):
    """Return the `Drive` of a vehicle at a speed [m/s]."""
    settings = tv.RunSettings(tv.Operation(speed, ENGINE_SPEED, False), tv.Rates(), passive_current=1.0)
    rate = settings.rates.control
    begin, speeds, squares, densities = round(SETTLING * rate), [], [], []
    for seed in SEEDS:
        simulation, road = tv.Simulation(vehicle, settings), tv.Iso8608Road(ROAD_CLASS, seed=seed)
        record = tv.run_open_loop(simulation, road, begin + round(MEASURING * rate))
        limited = [band_limited(record.specific_force[:, k], rate)[begin:] for k in range(len(LINES))]
        frequencies, spectra = zip(*(psd(each, rate) for each in limited), strict=True)
        speeds.append(record.speed[begin:].mean())
        squares.append([rms(each) ** 2 for each in limited])
        densities.append([spectrum[:, AXES.index("z")] for spectrum in spectra])
    levels, density = np.sqrt(np.mean(squares, axis=0)), np.mean(densities, axis=0)
    by_sensor = [dict(zip(LINES, each, strict=True)) for each in (levels, density)]
    return Drive(float(np.mean(speeds)), by_sensor[0], frequencies[0], by_sensor[1])


def peak(found, sensor, near=NEAR):
    """Return the frequency [Hz] of the highest line of the vertical between two."""
    inside = (found.frequency >= near[0]) & (found.frequency <= near[1])
    return found.frequency[inside][found.density[sensor][inside].argmax()]


def reduction(found, axis):
    """Return by how many per cent the powertrain's RMS is below the chassis's along an axis."""
    column = AXES.index(axis)
    return 100.0 * (1.0 - found.rms["powertrain"][column] / found.rms["chassis"][column])


def tell(pitch, drives, same):
    """Print both beside each other."""
    print(f"links of {pitch:g} m pass at {LINES['chassis']} Hz at {same.speed:.2f} m/s")
    print(f"{'reduction from chassis to powertrain, %':<42}{'field test':>11}{'here':>9}")
    for axis, name in (("z", "vertical"), ("y", "lateral"), ("x", "longitudinal")):
        print(f"  {name:<40}{REDUCTIONS[axis]:>11.2f}{reduction(same, axis):>z9.2f}")
    print(f"{f'highest line from {NEAR[0]:.0f} to {NEAR[1]:.0f} Hz, Hz':<42}{'field test':>11}{'here':>9}")
    for sensor, frequency in LINES.items():
        print(f"  {f'{sensor}, vertical':<40}{frequency:>11.2f}{peak(same, sensor):>9.2f}")
    print(f"{'RMS, m/s²':<12}{'speed, m/s':>10}" + "".join(f"{f'{s} {a}':>14}" for s in LINES for a in AXES))
    for each in drives:
        print(f"{'':<12}{each.speed:>10.2f}" + "".join(f"{each.rms[s][k]:>14.3f}" for s in LINES for k in range(3)))


def draw(drives, same):
    """Draw RMS against speed, and spectra of the vertical, where the test has its Figures 13 and 14."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for sensor, colour in zip(LINES, ("#4878a8", "#c8453c"), strict=True):
        for axis, style in zip(AXES, (":", "--", "-"), strict=True):
            levels = [each.rms[sensor][AXES.index(axis)] for each in drives]
            look = {"color": colour, "marker": ".", "label": f"{sensor} {axis}"}
            left.plot([each.speed for each in drives], levels, style, **look)
        right.semilogy(same.frequency, same.density[sensor], color=colour, linewidth=0.9, label=sensor)
        right.axvline(LINES[sensor], color=colour, linestyle=":", linewidth=1.2, label=f"line of the test's {sensor}")
    left.set(xlabel="speed, m/s", ylabel="RMS, m/s²", ylim=(0.0, None))
    right.set(xlabel="frequency, Hz", ylabel="vertical PSD, (m/s²)²/Hz", xlim=(0.0, 250.0), ylim=(1e-4, None))
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig("field_test.png", dpi=110)


def main():
    """Drive at several speeds, print and draw."""
    vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    pitch = vehicle.tracks.pitch
    drives = [drive(vehicle, part * LINES["chassis"] * pitch) for part in RELATIVE_SPEEDS]
    same = drives[RELATIVE_SPEEDS.index(1.0)]
    tell(pitch, drives, same)
    draw(drives, same)


if __name__ == "__main__":
    main()
