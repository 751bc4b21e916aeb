"""Ctrl-C and the like, kept out of ROS's C++ code."""

import signal
from contextlib import contextmanager

_ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextmanager
def put_off_interrupts():
    """Let signals that ask to end act after the block: an exception in the midst of a spin comes out as another one.

    Of the main thread only, as signals are.
    """
    noted = []
    handlers = {number: signal.signal(number, lambda number, _: noted.append(number)) for number in _ENDING}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        if noted:
            signal.raise_signal(noted[0])
