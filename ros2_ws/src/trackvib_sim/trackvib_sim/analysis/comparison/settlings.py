"""How long each of two recordings settles, by one rule."""

from ..segments import known_settling
from ..settling import SHORTEST_SETTLING


def settlings(recordings, settle=None):
    """Return for each recording the time from its start that does not count [s], and in words where that is from.

    `settle` [s] applies to all. Without it a recording settles as long as its own run tells. One that tells nothing, of
    a vehicle or in a CSV file, settles as long as the other one, so that both are compared over the same time.
    """
    if settle is not None:
        return [(settle, "as asked for")] * len(recordings)
    known = [known_settling(recording) for recording in recordings]
    most = max((each for each in known if each is not None), default=None)
    unknown = (SHORTEST_SETTLING, "the shortest") if most is None else (most, "as the other one, for it tells nothing")
    return [unknown if each is None else (each, "by its own run") for each in known]
