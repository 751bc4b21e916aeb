"""Pairs the samples of two sensors in a bag, whose stamps need not be the same."""

import struct
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.cdr import NANO, byte_order, leading_stamp

from .errors import BagError

_SWAPPED, _REPEATED = NANO, 0.1  # ns by which stamps may go back, and part of them that may come again
_STAMP = slice(4, 12)  # bytes of a message that begins with a header


class Samples(NamedTuple):
    """Pairs of Imu messages."""

    stamp: np.ndarray  # (k,) of the chassis, ns, increasing
    apart: np.ndarray  # (k,) by how much the powertrain's is later, ns
    messages: Iterator  # of the stamp and both messages as bytes, that of the powertrain with the stamp of the chassis


def paired_samples(bag, chassis, powertrain):
    """Return the `Samples` in an `OpenBag` for which both topics have a message within half a period of the chassis.

    Each message is in one pair at most; of several with one stamp the first counts.

    Raises
    ------
    BagError
        There is more than one run in the bag.
    """
    connections = {topic: [each for each in bag.connections if each.topic == topic] for topic in (chassis, powertrain)}
    (first, first_place), (second, second_place) = (_stamps(bag, connections[topic]) for topic in connections)
    near = nearest(first, second)
    stamp, apart = first[near[0]], second[near[1]] - first[near[0]]
    places = zip(first_place[near[0]].tolist(), second_place[near[1]].tolist(), strict=True)
    messages = (
        (time, data, _restamped(bag.message(other), data))
        for time, (place, other) in zip(stamp.tolist(), places, strict=True)
        for data in (bag.message(place),)
    )
    return Samples(stamp, apart, messages)


def nearest(first, second):
    """Return the indices (2, k) of pairs of increasing times (n,) and (m,) that are each other's nearest.

    They are at most half a period of the first ones apart.
    """
    if len(first) < 2 or not len(second):
        return np.empty((2, 0), np.int64)
    there, back = _nearest(first, second), _nearest(second, first)
    index = np.flatnonzero(back[there] == np.arange(len(first)))
    apart = np.abs(second[there[index]] - first[index])
    index = index[2 * apart <= np.median(np.diff(first))]
    return np.stack((index, there[index]))


def _nearest(times, others):
    """Return for each time the index of the nearest one of others, of two the earlier."""
    after = np.searchsorted(others, times).clip(1, max(len(others) - 1, 1))
    later = others[np.minimum(after, len(others) - 1)] - times < times - others[after - 1]
    return np.where(later, after, after - 1)


def _stamps(bag, connections):
    """Return the stamps (k,) of the messages of connections [ns], increasing, and their places in the bag."""
    places = bag.places(connections)
    stamp = np.array([leading_stamp(bag.message(place)) for place in places.tolist()], np.int64)
    _require_one_run(stamp, bag.times(places), connections)
    stamp, index = np.unique(stamp, return_index=True)
    return stamp, places[index]


def _require_one_run(stamp, time, connections):
    """Raise BagError if stamps in order of their recording begin anew; drivers swap and repeat some, which is no run.

    Of two runs in simulated time, which are recorded at their stamps, every message comes again at its time.
    """
    back = np.flatnonzero(np.diff(stamp) < -_SWAPPED)
    again = np.flatnonzero((np.diff(stamp) == 0) & (np.diff(time) == 0))
    if len(back) or len(again) > _REPEATED * len(stamp):
        first = stamp[back[0] if len(back) else again[0]]
        raise BagError(
            f"the bag holds more than one run: after t = {first / NANO:.3f} s {connections[0].topic} starts again"
        )


def _restamped(data, like):
    """Return a message with the stamp of another one."""
    if byte_order(data) == byte_order(like):
        return data[: _STAMP.start] + like[_STAMP] + data[_STAMP.stop :]
    stamp = struct.pack(f"{byte_order(data)}iI", *divmod(leading_stamp(like), NANO))
    return data[: _STAMP.start] + stamp + data[_STAMP.stop :]
