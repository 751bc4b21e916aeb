"""Waiting for others, by the time in which one was able to look."""

import time

_TICK = 0.1  # s, after which whoever waits looks at its stop flag
_ABSENT = 0.3  # s by which a look takes longer than asked for if the process did not run meanwhile
_LEAST = 1e-6  # s, less than any look takes: what is left of a patience then is rounding
_RESENT = 4.0  # s after which messages that were lost meanwhile have come again (Fast DDS: 3 s)


def wait_until(done, look, timeout=None):
    """Call `look(seconds)`, which waits that long at most, until `done()` or the timeout [s]; returns `done()`.

    A look that took longer than asked for counts as what was asked for: the rest is time in which this process itself
    did not run, on a loaded machine or stopped by a signal, and no silence of those it waits for. After a long absence
    the patience begins anew, and reaches until messages to the absent have been sent again.
    """
    waited = 0.0
    while not done():
        if timeout is not None and waited > timeout - _LEAST:
            return False
        asked = _TICK if timeout is None else min(_TICK, timeout - waited)
        began = time.monotonic()
        look(asked)
        took = time.monotonic() - began
        waited = -_RESENT if took > asked + _ABSENT else waited + min(took, asked)
    return True
