"""A rate that wanders: samples evenly taken by no clock, resampled to instants that are even."""

import numpy as np

from ...numerics.units import NANO
from ..stamps import BLOCK, blocks, period_of, timing
from .resampling import resampled

MOST = 0.25  # periods, by which stamps without a gap may leave a straight line
SPAN = 100  # samples, over which a rate is told


def at_even_instants(inertial, end):
    """Return a sensor's `Inertial` at even instants if its rate wanders, and notes; of these forces only.

    Parameters
    ----------
    inertial : Inertial
        With stamps upon a line.
    end : str
        Of its topic, for notes.
    """
    stamp = inertial.stamp
    if not period_of(stamp) > 0.0:
        return inertial, []
    edges = edges_of(stamp)
    parts = [slice(*each) for each in zip(edges[:-1], edges[1:], strict=True) if each[1] - each[0] > 1]
    off = max((_off_straight(stamp[part]) for part in parts), default=0.0)
    steps = sum(part.stop - part.start - 1 for part in parts)
    if not steps:
        return inertial, []
    period = sum(int(stamp[part.stop - 1] - stamp[part.start]) for part in parts) / steps
    if off <= MOST * period:
        return inertial, []
    stamps, forces, logged = zip(*(_resampled(inertial.at(part), int(stamp[0]), period) for part in parts), strict=True)
    found = inertial._replace(
        stamp=np.concatenate(stamps),
        specific_force=np.concatenate(forces),
        angular_velocity=None,
        logged=None if inertial.logged is None else np.concatenate(logged),
        covariance=None,
        orientation=None,
        orientation_covariance=None,
    )
    lowest, highest = _rates(stamp, parts)
    note = (
        f"{end}: its rate varies from {lowest:.4g} to {highest:.4g} Hz, and stamps deviate from even ones by "
        f"up to {off / NANO:.3g} s, {off / period:.3g} periods: resampled, band-limited, to even instants at "
        f"{NANO / period:.6g} Hz"
    )
    return found, [note]


def edges_of(stamp):
    """Return first indices of the stretches without a gap of stamps, and their number."""
    return [0, *timing(stamp, 0)[1].tolist(), len(stamp)]


def _off_straight(stamp):
    """Return by how much stamps (k,) leave the straight line from the first to the last, ns."""
    period = float(stamp[-1] - stamp[0]) / (len(stamp) - 1)
    return max(
        float(np.abs(stamp[block] - stamp[0] - period * np.arange(block.start, block.stop)).max())
        for block in blocks(len(stamp), BLOCK)
    )


def _rates(stamp, parts):
    """Return the lowest and highest rate [Hz] over `SPAN` samples of parts of stamps."""
    span = min(SPAN, max(part.stop - part.start for part in parts) - 1)
    means = [(stamp[part][span:] - stamp[part][:-span]) / span for part in parts if part.stop - part.start > span]
    return NANO / max(mean.max() for mean in means), NANO / min(mean.min() for mean in means)


def _resampled(inertial, origin, period):
    """Return stamps, specific forces and times of recording at whole numbers of periods [ns] after an origin."""
    stamp, samples = inertial.stamp - origin, np.arange(len(inertial.stamp))
    number = np.arange(np.ceil(stamp[0] / period), np.floor(stamp[-1] / period) + 1)
    place = np.interp(period * number, stamp, samples)
    logged = None
    if inertial.logged is not None:
        logged = origin + np.round(np.interp(place, samples, inertial.logged - origin)).astype(np.int64)
    return origin + np.round(period * number).astype(np.int64), resampled(inertial.specific_force, place), logged
