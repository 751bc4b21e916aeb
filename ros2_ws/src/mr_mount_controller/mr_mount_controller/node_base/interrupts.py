"""Ctrl-C and the like, kept out of ROS's C++ code."""

import signal
from contextlib import contextmanager

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextmanager
def put_off_interrupts():
    """Let signals that ask to end act after the block: an exception in the midst of a spin comes out as another one.

    Of the main thread only, as signals are.
    """
    noted = []
    handlers = {number: signal.signal(number, lambda number, _: noted.append(number)) for number in ENDING}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        if noted:
            signal.raise_signal(noted[0])


@contextmanager
def block_interrupts():
    """Let signals that ask to end wait until after the block; a process that is started in it begins with them waiting.

    Of the calling thread, whatever handlers there are.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
