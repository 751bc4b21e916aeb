"""A recorded run as an animated picture (GIF), for documents."""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from PIL import Image

from ..analysis.sensor_style import COLOURS
from ..console import followed
from ..numerics.units import NANO
from ..scene.colours import DAMPED, POWERTRAIN_SHADE, SENSORS, of_load
from ..vehicle.system import Operation, build_system
from .painter import Painter
from .road import strips_of

MOST_FRAMES = 400
_SIZE, _DPI = (6.4, 4.6), 100  # inches; pixels an inch
_COLOURS = 96
_INK = "#3c4248"
_STEP = 1e-4  # s, of a system of which only the geometry is used
_VIEW = ((-5.3, 5.3), (-1.75, 2.65))  # m that the camera sees at the vehicle, across and up


def animated_picture(recording, vehicle, motion, path, console):
    """Draw the `motion.Motion` of a vehicle above two curves of its `Recording` to a GIF file.

    Raises
    ------
    ValueError
        There are more frames than fit a picture.
    """
    if len(motion.time) > MOST_FRAMES:
        raise ValueError(
            f"{len(motion.time)} frames, accepted in a picture are {MOST_FRAMES}; choose --start and --end"
        )
    strips = strips_of(recording, vehicle, motion.way) if recording.road else None
    painter = Painter(vehicle, build_system(vehicle, Operation(0.0, 0.0, False), _STEP), strips)
    loads = _loads(recording, motion, painter.mounts)
    figure = Figure(figsize=_SIZE, dpi=_DPI)
    canvas = FigureCanvasAgg(figure)
    stage = figure.add_axes((0.0, 0.29, 1.0, 0.71))
    cursors = _curves(figure, recording, motion, painter.mounts)
    pictures = []
    frames = list(zip(motion.time, motion.poses, loads, strict=True))
    for time, pose, load in followed(frames, "drawing", console):
        _draw(stage, painter.paint(pose, load), f"{vehicle.name}   t = {time / NANO:.2f} s")
        for cursor in cursors:
            cursor.set_xdata([time / NANO] * 2)
        canvas.draw()
        pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3]))
    palette = _palette(pictures[len(pictures) // 2])
    first, *others = (each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures)
    span = float(motion.time[-1] - motion.time[0]) / NANO / max(len(pictures) - 1, 1)
    with path.open("wb") as file:
        duration = max(20, round(1e3 * span))  # ms a frame
        first.save(file, "GIF", save_all=True, append_images=others, duration=duration, loop=0, optimize=True)


def _palette(picture):
    """One palette for all frames, so that what does not move is not stored again; with the colours of small things."""
    small = np.concatenate((of_load(np.linspace(0.0, 1.0, 12)), [DAMPED, POWERTRAIN_SHADE, *SENSORS.values()]))
    band = np.repeat(np.repeat(small[None].astype(np.uint8), picture.width // len(small) + 1, axis=1), 40, axis=0)
    sample = np.concatenate((np.asarray(picture), band[:, : picture.width]))
    return Image.fromarray(sample).quantize(_COLOURS, dither=Image.Dither.NONE)


def _loads(recording, motion, mounts):
    """Colours of the mounts by frame (k, m): current of its highest, or force of the greatest one in the run."""
    if recording.mounts is None:
        return np.zeros((len(motion.time), len(mounts.names)))
    row = np.clip(np.searchsorted(recording.mounts.stamp, motion.time, "right") - 1, 0, None)
    force = np.abs(recording.mounts.force[row, :, 2])
    loads = force / max(float(force.max(initial=0.0)), 1.0)
    loads[:, : mounts.coils] = recording.mounts.current[row] / mounts.highest
    return loads


def _draw(stage, paint, words):
    stage.clear()
    stage.set_aspect("equal")
    stage.set(xlim=_VIEW[0], ylim=_VIEW[1])
    stage.axis("off")
    style = {"edgecolors": "face", "linewidths": 0.3, "antialiaseds": True}
    stage.add_collection(PolyCollection(paint.solid, facecolors=paint.colours, **style))
    lines = LineCollection(paint.springs, colors=paint.spring_colours, linewidths=3.0, zorder=5)
    stage.add_collection(lines)
    clear = [(*colour, 0.13) for colour in paint.clear_colours]
    edges = [(*0.75 * colour, 0.7) for colour in paint.clear_colours]
    stage.add_collection(PolyCollection(paint.clear, facecolors=clear, edgecolors=edges, linewidths=0.6))
    stage.text(0.01, 0.97, words, transform=stage.transAxes, va="top", fontsize=8, color=_INK, parse_math=False)


def _curves(figure, recording, motion, mounts):
    """Draw accelerations and, where there are coils, currents, else forces; returns the lines that show the time."""
    first, last = (float(each) / NANO for each in motion.time[[0, -1]])
    left, right = figure.add_axes((0.08, 0.08, 0.40, 0.17)), figure.add_axes((0.57, 0.08, 0.40, 0.17))
    for name, sensor in (("chassis", recording.chassis), ("powertrain", recording.powertrain)):
        _plot(left, sensor.stamp, sensor.specific_force[:, 2] - 9.81, first, last, COLOURS[name], name)
    left.set_title("vertical acceleration, m/s²", fontsize=7, color=_INK)
    if recording.mounts is not None:
        values = recording.mounts.current if mounts.coils else 1e-3 * recording.mounts.force[:, :, 2]
        for k, name in enumerate(mounts.names[: values.shape[1]]):
            _plot(right, recording.mounts.stamp, values[:, k], first, last, f"C{k % 10}", name)
    right.set_title("coil current, A" if mounts.coils else "mount force upwards, kN", fontsize=7, color=_INK)
    for plot in (left, right):
        plot.set_xlim(first, last)
        plot.tick_params(labelsize=6, colors=_INK)
        if plot.lines and len(plot.lines) <= 4:
            plot.legend(fontsize=6, loc="upper right", frameon=False, ncols=2)
    return [plot.axvline(first, color=_INK, linewidth=0.8) for plot in (left, right)]


def _plot(plot, stamp, values, first, last, colour, name):
    shown = (stamp >= first * NANO) & (stamp <= last * NANO)
    plot.plot(stamp[shown] / NANO, values[shown], color=colour, linewidth=0.5, label=name.replace("_", " "))
