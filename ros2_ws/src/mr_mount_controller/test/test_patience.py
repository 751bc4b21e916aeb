"""Analytic: how long a wait takes, by a clock of the test's own."""

import pytest
from mr_mount_controller.node_base import patience

pytestmark = pytest.mark.analytic


@pytest.fixture
def clock(monkeypatch):
    """A clock that only looks move: `clock[0]` is its time [s]."""
    now = [0.0]
    monkeypatch.setattr(patience.time, "monotonic", lambda: now[0])
    return now


def test_a_silent_partner_is_waited_for_as_long_as_asked(clock):
    def look(seconds):
        clock[0] += seconds

    assert not patience.Patience(look).wait_until(lambda: False, 1.25)
    assert clock[0] == pytest.approx(1.25)


@pytest.mark.parametrize("timeout", [None, 1.0])
def test_who_comes_ends_the_wait(clock, timeout):
    def look(seconds):
        clock[0] += seconds / 2

    assert patience.Patience(look).wait_until(lambda: clock[0] >= 0.7, timeout)
    assert clock[0] < 0.8


def test_each_look_counts_as_what_was_asked_for(clock):
    """On a machine so loaded that every look takes 0.25 s longer, ten looks of 0.1 s are a second of patience."""
    looks = []

    def look(seconds):
        looks.append(seconds)
        clock[0] += seconds + 0.25

    assert not patience.Patience(look).wait_until(lambda: False, 1.0)
    assert len(looks) in (10, 11) and sum(looks) == pytest.approx(1.0)


def test_after_an_absence_patience_begins_anew(clock):
    """Stopped for 15 s within the last look: who answers two seconds later is in time."""
    waited = []

    def look(seconds):
        clock[0] += seconds + (15.0 if 0.85 < clock[0] < 0.95 else 0.0)
        waited.append(clock[0])

    assert patience.Patience(look).wait_until(lambda: clock[0] > 18.0, 1.0)
    assert not patience.Patience(look).wait_until(lambda: False, 1.0)


def test_an_absence_between_two_looks_counts_as_well(clock):
    """Stopped while it publishes, say: what is lost then comes again after some seconds."""

    def look(seconds):
        clock[0] += seconds

    waiting = patience.Patience(look)
    assert waiting.wait_until(lambda: clock[0] > 0.5, 1.0)
    clock[0] += 15.0
    assert waiting.wait_until(lambda: clock[0] > 18.6, 0.5)
    assert not waiting.wait_until(lambda: False, 0.5)
