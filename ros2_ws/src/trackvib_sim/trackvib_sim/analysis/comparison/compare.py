"""From two recordings and their `Analysis`es to the `Comparison`: a table of contents."""

from dataclasses import dataclass

import numpy as np

from ..iso2631 import LEAST_RATE
from ..lines import known_lines, read_causes
from ..motion import mean_motion
from ..numbers import AXES, SENSORS, SPEED_BAND
from ..segments import find_segments
from ..vibration import LOWEST
from .bands import Band, common_bands, line_bands
from .intervals import CONFIDENCE, jackknifed, ratio_interval
from .windows import frequencies, windows_of

ALIGNMENTS = AUTO, BY_SPEED, BY_DISTANCE, NOT = ("auto", "speed", "distance", "none")
TRUSTED = 0.45  # of the lower rate, up to which both drives are compared
LEAST_WINDOWS = 3  # of each drive in a band of speed, for it to be compared
LEAST_LEVEL = 1e-9  # m/s^2, below which there is nothing but rounding
THROUGH = "chassis to powertrain"


@dataclass(frozen=True)
class Ratio:
    """A number of both drives, and the simulated over the measured one."""

    part: str  # "chassis", "powertrain", or from one to the other
    axis: str
    quantity: str
    unit: str
    frequency: float  # Hz, of a third octave or of the measured line; nan of wide bands
    measured: float
    simulated: float
    ratio: float
    low: float  # of the confidence interval of the ratio
    high: float


@dataclass(frozen=True)
class Comparison:
    """A measured drive beside a simulated one."""

    measured: str  # path
    simulated: str
    aligned_by: str  # "speed", "distance", or "none": statistics of all time that counts
    confidence: float
    settle: tuple  # of each drive, time from the start that does not count, s
    windows: tuple  # how many of each drive are compared
    band: tuple  # Hz
    ratios: tuple  # of `Ratio`s
    notes: tuple  # sentences


def compare(recordings, analyses, align=AUTO, interval=50.0, speed_band=SPEED_BAND):
    """Return the `Comparison` of two recordings on one time base, measured and simulated, with their `Analysis`es.

    What does not count of each is as in its analysis.

    Raises
    ------
    ValueError
        They have no speed or no way in common and should be aligned by it, or are too short.
    """
    rate = min(analysis.rate for analysis in analyses)
    highest = TRUSTED * rate
    lines, notes = _lines(recordings, analyses)
    bands = []
    for analysis, known in zip(analyses, lines, strict=True):
        frequency = frequencies(analysis.rate)
        found = line_bands(frequency, known, highest)
        bands.append((common_bands(frequency, highest, rate >= LEAST_RATE), found))
    names = [name for name in bands[0][1] if name in bands[1][1]]
    bands = [[*common, *(found[name] for name in names)] for common, found in bands]
    windows = [
        windows_of(recording, find_segments(recording, analysis.settle), of_drive)
        for recording, analysis, of_drive in zip(recordings, analyses, bands, strict=True)
    ]
    aligned_by, strata, weights = _strata(windows, align, interval, speed_band)
    if aligned_by == NOT and align == AUTO:
        notes.append(
            "the speeds of the drives do not overlap or are unknown: statistics of all time that counts are compared"
        )
    results = []
    for found, stratum in zip(windows, strata, strict=True):
        kept = stratum >= 0
        power = found.power[kept].reshape(kept.sum(), -1)
        cross = found.cross[kept].reshape(kept.sum(), -1)
        columns = np.concatenate((power, cross.real, cross.imag), axis=1)
        results.append(jackknifed(columns, stratum[kept], weights, _derived(len(bands[0]))))
    ratios = tuple(_records(bands[0], results))
    counts = tuple(int((stratum >= 0).sum()) for stratum in strata)
    paths = (str(recording.path) for recording in recordings)
    settle = tuple(analysis.settle for analysis in analyses)
    return Comparison(*paths, aligned_by, CONFIDENCE, settle, counts, (LOWEST, highest), ratios, tuple(notes))


def _lines(recordings, analyses):
    """Return the `Line`s of each drive; of one whose vehicle is not told those of the other's vehicle at its speed."""
    notes, found = [], [analysis.lines for analysis in analyses]
    pitch, orders, missing = read_causes(recordings[1])
    if not recordings[0].vehicle and not missing:
        analysis = analyses[0]
        motion = mean_motion(recordings[0], analysis.begin + round(1e9 * analysis.settle))
        found[0], _ = known_lines(analysis.spectra, motion, pitch, orders)
        if found[0]:
            notes.append("lines of the measured drive are those of the simulated vehicle, at the speed measured")
    return found, notes


def _strata(windows, align, interval, speed_band):
    """Return how the drives are aligned, of each the stratum (n,) of its windows (-1: of none), and weights (s,)."""
    for kind, signal, width in ((BY_SPEED, "speed", speed_band), (BY_DISTANCE, "way", interval)):
        if align not in (kind, AUTO) or (align == AUTO and kind == BY_DISTANCE):
            continue
        index = [np.floor(getattr(each, signal) / width) for each in windows]
        least = LEAST_WINDOWS if kind == BY_SPEED else 1
        counted = [dict(zip(*np.unique(each[np.isfinite(each)], return_counts=True), strict=True)) for each in index]
        common = sorted(k for k in counted[0] if min(counted[0][k], counted[1].get(k, 0)) >= least)
        if common:
            strata = [np.array([common.index(k) if k in common else -1 for k in each]) for each in index]
            return kind, strata, np.array([counted[0][k] for k in common], float)
        if align == kind:
            raise ValueError(f"the drives have no {kind} in common, of {least} windows at least, to be aligned by")
    return NOT, [np.zeros(len(each.speed), int) for each in windows], np.ones(1)


def _derived(bands):
    """Return what turns averages of powers and cross powers into logarithms of levels and transmissibilities."""
    powers, crosses = bands * len(SENSORS) * len(AXES), bands * len(AXES)

    def derive(averages):
        power = averages[:, :powers].reshape(-1, bands, len(SENSORS), len(AXES))
        real, imaginary = (
            averages[:, powers + part * crosses :][:, :crosses].reshape(-1, bands, len(AXES)) for part in (0, 1)
        )
        power = np.where(power >= LEAST_LEVEL**2, power, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            level = 0.5 * np.log(power)
            through = 0.5 * np.log(real**2 + imaginary**2) - np.log(power[:, :, 0])
        found = np.concatenate((level, through[:, :, None]), axis=2).reshape(len(averages), -1)
        return np.where(np.isfinite(found), found, np.nan)

    return derive


def _records(bands: list[Band], results):
    """Iterate over the `Ratio`s, sensor by sensor; quantities that neither drive has are left out."""
    shape = (len(bands), len(SENSORS) + 1, len(AXES))
    values = [np.exp(result[0]).reshape(shape) for result in results]
    ratio, low, high = (each.reshape(shape) for each in ratio_interval(*results))
    for place, part in enumerate((*SENSORS, THROUGH)):
        for column, axis in enumerate(AXES):
            for row, band in enumerate(bands):
                cell = row, place, column
                through = part == THROUGH
                told = np.isfinite([each[cell] for each in values]).any()
                if told and ("third" in band.quantity or not through):
                    yield Ratio(
                        part,
                        axis,
                        "transmissibility, third octave" if through else band.quantity,
                        "-" if through else "m/s²",
                        *map(float, (band.frequency, *(each[cell] for each in values))),
                        *(float(each[cell]) for each in (ratio, low, high)),
                    )
