"""The order in which messages of a topic follow each other in time."""

import numpy as np

from ...numerics.units import NANO

MOST_RUNS = 1000  # in which the file goes on; of more each message is put in its place by itself
LOCAL = 0.1  # s, by which a recorder of several threads may write messages late


def time_order(stamp, logged, force):
    """Return the indices (n,) of messages in their order of time, without copies; None where they stand so already.

    A file may hold its parts in any order; the times at which messages were recorded tell it. Where these go back over
    times that are there already, and not by copies of messages, the recorder's clock was set: the file's order counts.

    Parameters
    ----------
    stamp, logged : (k,) int
        ns; where the recorder took the stamps for its times (`logged` None) they count as such.
    force : (k, 3) array
    """
    local = LOCAL * NANO if logged is not None else 0
    logged = stamp if logged is None else logged
    back = np.flatnonzero(np.diff(logged) < 0) + 1
    if not back.size:
        return None
    ordered = np.argsort(logged, kind="stable")
    depth = (logged[back - 1] - logged[back]).max()
    if depth <= local:
        return ordered
    first, last = logged[np.append(0, back)], logged[np.append(back, len(logged)) - 1]
    runs = np.argsort(first, kind="stable")
    if back.size < MOST_RUNS and (first[runs][1:] >= last[runs][:-1]).all():
        return ordered
    copied = _copied(stamp[ordered], logged[ordered], force[ordered])
    return ordered[~copied] if copied.any() else None


def _copied(stamp, logged, force):
    """Return which messages are those before them once more."""
    same = (np.diff(stamp) == 0) & (np.diff(logged) == 0) & (np.diff(force, axis=0) == 0.0).all(axis=1)
    return np.append(False, same)
