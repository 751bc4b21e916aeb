"""Waiting for others, by the time in which one was able to look."""

import time

_TICK = 0.1  # s, after which whoever waits looks at its stop flag
_ABSENT = 0.3  # s between the ends of two looks, beyond what the second may take: the process did not run meanwhile
_LEAST = 1e-6  # s, less than any look takes: what is left of a patience then is rounding
_RESENT = 4.0  # s after which messages that were lost meanwhile have come again (Fast DDS: 3 s)


class Patience:
    """How long one waits for others.

    A look that took longer than asked for counts as what was asked for: the rest is time in which this process itself
    did not run, on a loaded machine or stopped by a signal, and no silence of those it waits for. After a long absence,
    within a look or since the last one, patience begins anew, and reaches until messages to the absent have been sent
    again.
    """

    def __init__(self, look):
        """`look(seconds)` serves what has come, and waits for it that long at most."""
        self._look, self._looked = look, time.monotonic()

    def look(self, seconds):
        """Look once, that long at most; returns the seconds that count, below zero after an absence."""
        before, began = self._looked, time.monotonic()
        self._look(seconds)
        self._looked = time.monotonic()
        return -_RESENT if self._looked - before > seconds + _ABSENT else min(self._looked - began, seconds)

    def wait_until(self, done, timeout=None):
        """Look until `done()` or the timeout [s]; returns `done()`."""
        waited = 0.0
        while not done():
            if timeout is not None and waited > timeout - _LEAST:
                return False
            counts = self.look(_TICK if timeout is None else min(_TICK, timeout - waited))
            waited = counts if counts < 0.0 else waited + counts
        return True
