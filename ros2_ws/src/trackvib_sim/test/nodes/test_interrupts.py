"""Interrupts wait until a spin is over."""

import signal

import pytest
from mr_mount_controller.node_base.interrupts import put_off_interrupts

pytestmark = pytest.mark.property


@pytest.fixture(autouse=True)
def python_interrupts():
    """Python's own handler, which a test run in the background of a script does not have."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("error", [None, RuntimeError("from elsewhere")])
def test_an_interrupt_acts_after_the_block(error):
    """As it would have without the block, also where something else has gone wrong in it."""
    before, done = signal.getsignal(signal.SIGINT), []
    with pytest.raises(KeyboardInterrupt), put_off_interrupts():
        signal.raise_signal(signal.SIGINT)
        done.append("the rest")
        if error is not None:
            raise error
    assert done == ["the rest"] and signal.getsignal(signal.SIGINT) is before


def test_without_an_interrupt_nothing_happens():
    """And handlers are those of before."""
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    with put_off_interrupts():
        pass
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)] == before
