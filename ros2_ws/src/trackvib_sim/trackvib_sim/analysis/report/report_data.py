"""What a report keeps of a recording: little enough to hold many, and to send to a browser."""

from bisect import bisect_right
from typing import NamedTuple

import numpy as np
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

from ...numerics.units import NANO
from ..numbers import AXES, SENSORS, Analysis
from ..stamps import BLOCK, blocks
from .thinning import thinned

WINDOW = 0.5  # s of a spectrogram: bins of 2 Hz
COLUMNS = 300  # of a spectrogram, at most
CELLS = 40  # along each side of a map of density
EXCERPT = 1.0  # s of a mount's loop that is drawn as a line
TICKS = 2.5  # periods, beyond which a line through samples is broken
VERTICAL = AXES.index("z")


class Spectrogram(NamedTuple):
    """Power spectral density over time."""

    time: np.ndarray  # (n,) s, middle of each column
    frequency: np.ndarray  # (f,) Hz
    level: np.ndarray  # (f, n) dB re 1 (m/s²)²/Hz; nan where samples are missing


class Loop(NamedTuple):
    """Vertical force of a mount over something else: where it was in the run, and a second of it."""

    across: np.ndarray  # (c,) middles of the cells
    force: np.ndarray  # (c,) kN, likewise
    density: np.ndarray  # (c, c) log10 of the samples in each cell, force by across; nan where none is
    line: tuple  # (across, force), about the moment of greatest travel


class ReportData(NamedTuple):
    """All that a report shows of one bag."""

    analysis: Analysis
    provenance: dict  # metadata record -> dict of text
    vehicle: str | None  # text of the vehicle file
    accelerations: dict  # sensor -> axis -> line (time, m/s²)
    spectrograms: dict  # sensor -> Spectrogram of the vertical
    demanded: dict  # coil -> line (time, A)
    currents: dict  # the same in the coil
    deflection_loops: dict  # mount -> Loop over deflection in mm; empty without mount states
    velocity_loops: dict  # mount -> Loop over velocity in m/s


def build_report_data(recording, analysis):
    """Return the `ReportData` of a `bags.recording.Recording` and its `Analysis`."""
    step = TICKS / analysis.rate
    sensors = {sensor: getattr(recording, sensor) for sensor in SENSORS}
    times = {sensor: Seconds(inertial.stamp, analysis.begin) for sensor, inertial in sensors.items()}
    mounts, answers = recording.mounts, recording.answers
    demanded, currents, deflections, velocities = {}, {}, {}, {}
    names, coils = recording.mounting.names, recording.mounting.coils
    for sources, stamp, lines in ((answers, "sample_stamp", demanded), (mounts, "stamp", currents)):
        if sources is not None:
            time = Seconds(getattr(sources, stamp), analysis.begin)
            for column, coil in enumerate(names[:coils]):
                lines[coil] = thinned(time, sources.current[:, column], step)
    if mounts is not None:
        settled = bisect_right(mounts.stamp, analysis.begin + round(analysis.settle * NANO))
        for column, mount in enumerate(names):
            deflection, velocity, force = (
                each[settled:, column, VERTICAL] for each in (mounts.deflection, mounts.velocity, mounts.force)
            )
            if len(deflection):
                mean = analysis.mounts[mount].axes["z"].deflection_mean
                around = _greatest(deflection, mean, round(EXCERPT * analysis.rate))
                deflections[mount] = _loop(deflection, 1e3, force, around)
                velocities[mount] = _loop(velocity, 1.0, force, around)
    return ReportData(
        analysis,
        recording.provenance,
        recording.vehicle,
        {
            sensor: {
                axis: thinned(times[sensor], inertial.specific_force[:, column], step)
                for column, axis in enumerate(AXES)
            }
            for sensor, inertial in sensors.items()
        },
        {
            sensor: spectrogram(times[sensor], inertial.specific_force[:, VERTICAL], analysis.rate, analysis.duration)
            for sensor, inertial in sensors.items()
        },
        demanded,
        currents,
        deflections,
        velocities,
    )


class Seconds:
    """Stamps (k,) [ns] as seconds since `begin` [ns], converted where they are looked at."""

    def __init__(self, stamp, begin):
        self._stamp, self._begin = stamp, begin

    def __len__(self):
        return len(self._stamp)

    def __getitem__(self, index):
        return (self._stamp[index] - self._begin) / NANO


def spectrogram(time, values, rate, duration):
    """Return the `Spectrogram` of samples (k,) at times (k,) [s] from the start of a bag of a duration [s].

    Each column is the mean over its time; one in which samples are missing stays empty.
    """
    window = min(max(round(WINDOW * rate), 2), len(values))
    columns = max(1, min(COLUMNS, int(8.0 * duration / WINDOW)))
    # a column of many windows takes them half overlapping
    transform = ShortTimeFFT(hann(window, sym=False), window // 2 or 1, fs=rate, scale_to="psd", fft_mode="onesided2X")
    edges = np.linspace(0.0, duration, columns + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    level = np.full((transform.f_pts, columns), np.nan, np.float32)
    half = max(0.5 * (edges[1] - edges[0]), 0.5 * window / rate)
    # at the ends the window keeps its length and lies inside
    centre = np.clip(middle, half, max(duration - half, half))
    first, last = ([bisect_right(time, edge) for edge in centre + side * half] for side in (-1.0, 1.0))
    for column, (begin, end) in enumerate(zip(first, last, strict=True)):
        part = values[begin:end]
        if len(part) < window - 1 or abs((time[end - 1] - time[begin]) * rate - (len(part) - 1)) > 0.5:
            continue
        part = np.pad(part, (0, max(window - len(part), 0)), mode="edge")  # rounding may have cost one sample
        inside = transform.lower_border_end[1], transform.upper_border_begin(len(part))[1]
        power = transform.spectrogram(part, detr="constant", p0=inside[0], p1=max(inside[1], inside[0] + 1))
        level[:, column] = 10.0 * np.log10(np.maximum(power.mean(axis=1), 1e-30))
    return Spectrogram(middle.astype(np.float32), transform.f.astype(np.float32), level)


def _greatest(deflection, mean, length):
    """Return the slice of a length about the greatest distance from the mean."""
    greatest, place = -1.0, 0
    for block in blocks(len(deflection), BLOCK):
        distance = np.abs(deflection[block] - mean)
        index = int(distance.argmax())
        if distance[index] > greatest:
            greatest, place = distance[index], block.start + index
    first = max(0, min(place - length // 2, len(deflection) - length))
    return slice(first, first + length)


def _loop(across, factor, force, around):
    """Return the `Loop` of a force [N] over something times a factor; the slice `around` is its line."""
    ranges = [_range(each, scale) for each, scale in ((force, 1e-3), (across, factor))]
    counts = np.zeros((CELLS, CELLS))
    for block in blocks(len(force), BLOCK):
        found, *edges = np.histogram2d(1e-3 * force[block], factor * across[block], CELLS, ranges)
        counts += found
    with np.errstate(divide="ignore"):
        density = np.log10(counts)
    density[counts == 0.0] = np.nan
    rows, columns = (0.5 * (edge[1:] + edge[:-1]).astype(np.float32) for edge in edges)
    line = (factor * across[around]).astype(np.float32), (1e-3 * force[around]).astype(np.float32)
    return Loop(columns, rows, density.astype(np.float32), line)


def _range(values, scale):
    """Return the least and the greatest finite value times a scale; some range if there is none."""
    least, greatest = np.inf, -np.inf
    for block in blocks(len(values), BLOCK):
        finite = values[block][np.isfinite(values[block])]
        least, greatest = min(least, finite.min(initial=np.inf)), max(greatest, finite.max(initial=-np.inf))
    return [scale * least, scale * greatest] if least <= greatest else [0.0, 1.0]
