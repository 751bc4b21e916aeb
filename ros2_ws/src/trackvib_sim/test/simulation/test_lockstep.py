"""The rules by which an answer to a sample is judged, in lock-step and in real time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.simulation.lockstep import OUTCOMES, Lockstep

MS = 1_000_000
USABLE = (0.7, 4.0)
NAN, INF = float("nan"), float("inf")


def running(lockstep, samples=3, answered=1):
    """An exchange with samples 1 ... `samples` ms out, of which `answered` has its answer of 1.5 A."""
    exchange = Lockstep(2, 1.0, USABLE, lockstep)
    for k in range(1, samples + 1):
        exchange.publish(k * MS)
        if k == answered:
            assert exchange.offer(k * MS, (1.5, 1.5)) == "accepted"
    return exchange


@pytest.mark.property
@pytest.mark.parametrize(
    ("lockstep", "stamp", "currents", "outcome", "in_force"),
    [
        (True, 3, (2.0, 2.5), "accepted", [2.0, 2.5]),
        (True, 2, (2.0, 2.0), "late", [1.5, 1.5]),
        (True, 1, (2.0, 2.0), "duplicate", [1.5, 1.5]),
        (True, 0, (2.0, 2.0), "late", [1.5, 1.5]),
        (True, 4, (2.0, 2.0), "early", [1.5, 1.5]),
        (True, 3, (2.0, NAN), "not_finite", [1.5, 1.5]),
        (True, 3, (INF, 2.0), "not_finite", [1.5, 1.5]),
        (True, 4, (NAN, 2.0), "early", [1.5, 1.5]),
        (False, 3, (2.0, 2.5), "accepted", [2.0, 2.5]),
        (False, 2, (2.0, 2.0), "late", [2.0, 2.0]),
        (False, 1, (2.0, 2.0), "duplicate", [1.5, 1.5]),
        (False, 0, (2.0, 2.0), "late", [1.5, 1.5]),
        (False, 4, (2.0, 2.0), "early", [1.5, 1.5]),
        (False, 2, (NAN, NAN), "not_finite", [1.5, 1.5]),
    ],
)
def test_outcomes(lockstep, stamp, currents, outcome, in_force):
    """After samples 1, 2, 3 and an answer to 1, each offer has its outcome, its count and its effect."""
    exchange = running(lockstep)
    before = exchange.counts.copy()
    assert exchange.offer(stamp * MS, currents) == outcome
    assert exchange.currents.tolist() == in_force
    assert exchange.counts - before == {outcome: 1}
    assert exchange.answered == (outcome == "accepted")


@pytest.mark.property
@pytest.mark.parametrize("lockstep", [True, False])
def test_accepted_answer_is_given_once(lockstep):
    """A second answer to the same sample is a duplicate, and the first one stays in force."""
    exchange = running(lockstep)
    assert exchange.offer(3 * MS, (2.0, 2.0)) == "accepted"
    assert exchange.offer(3 * MS, (3.0, 3.0)) == "duplicate"
    assert exchange.currents.tolist() == [2.0, 2.0]
    assert exchange.answered_stamp == 3 * MS


@pytest.mark.property
@pytest.mark.parametrize(
    ("currents", "counted"),
    [((0.7, 4.0), 0), ((0.69, 1.0), 1), ((1.0, 4.01), 1), ((0.0, 9.0), 1), ((-1.0, 1.0), 1)],
)
def test_saturation_is_counted_and_accepted(currents, counted):
    """A current that driver or mounts will cut is accepted as it is and counted once."""
    exchange = running(True)
    assert exchange.offer(3 * MS, currents) == "accepted"
    assert exchange.counts["saturated"] == counted
    assert exchange.currents.tolist() == list(currents)


@pytest.mark.property
def test_unused_answers_do_not_count_as_saturated():
    """An answer that is not put in force cannot saturate anything."""
    exchange = running(True)
    for stamp in (2, 1, 4):
        exchange.offer(stamp * MS, (9.0, 9.0))
    assert exchange.counts["saturated"] == 0


@pytest.mark.property
def test_silence_falls_back_until_the_next_answer():
    """A fall-back is in force until an answer is accepted, and does not count as one."""
    exchange = running(True)
    exchange.fall_back(1.0)
    assert exchange.currents.tolist() == [1.0, 1.0]
    assert not exchange.answered and exchange.counts["accepted"] == 1
    assert exchange.offer(3 * MS, (2.0, 2.0)) == "accepted"
    assert exchange.currents.tolist() == [2.0, 2.0]


@pytest.mark.property
def test_before_the_first_sample_nothing_is_accepted():
    """Without a sample no answer answers anything, and the initial current is in force."""
    exchange = Lockstep(2, 1.2, USABLE)
    assert not exchange.answered
    assert exchange.offer(MS, (2.0, 2.0)) == "early"
    assert exchange.currents.tolist() == [1.2, 1.2]
    assert set(exchange.counts) == set(OUTCOMES)


@pytest.mark.property
def test_offered_currents_are_copied():
    """An answer changed by its giver afterwards does not change the currents in force."""
    exchange, answer = running(True), np.array([2.0, 2.0])
    exchange.offer(3 * MS, answer)
    answer[:] = 9.0
    assert exchange.currents.tolist() == [2.0, 2.0]


@pytest.mark.property
@pytest.mark.parametrize("coils", [0, 1, 2, 4, 16])
def test_any_number_of_coils(coils):
    """All are put in force together; one that is not finite spoils the answer, one beyond the limits is counted."""
    exchange, currents = Lockstep(coils, 1.0, USABLE), np.linspace(1.0, 2.0, coils)
    assert exchange.currents.tolist() == [1.0] * coils
    exchange.publish(MS)
    for bad in (NAN, INF):
        if coils:
            assert exchange.offer(MS, [*currents[:-1], bad]) == "not_finite"
    assert exchange.offer(MS, currents.tolist()) == "accepted"
    assert exchange.currents.tolist() == currents.tolist()
    exchange.publish(2 * MS)
    assert exchange.offer(2 * MS, [*currents[:-1], 9.0][:coils]) == "accepted"
    assert exchange.counts["saturated"] == (coils > 0)


EVENTS = st.lists(
    st.one_of(
        st.just("publish"),
        st.tuples(st.integers(-2, 2), st.sampled_from([0.0, 0.8, 1.0, 2.0, 9.0, NAN, -INF])),
    ),
    max_size=40,
)


@pytest.mark.property
@given(events=EVENTS, lockstep=st.booleans())
def test_currents_in_force_are_those_of_the_rules(events, lockstep):
    """Whatever is offered in whatever order, the currents in force follow from the rules written out plainly.

    In lock-step: those of the first finite answer to the latest sample that got one while it was the latest. In
    real time: those of the answer to the newest sample among the finite answers, the first of them.
    """
    exchange, latest, offers = Lockstep(2, 1.0, USABLE, lockstep), 0, []
    for event in ["publish", *events]:
        if event == "publish":
            latest += 1
            exchange.publish(latest * MS)
        else:
            stamp, current = latest + event[0], event[1]
            if stamp >= 1:
                exchange.offer(stamp * MS, (current, 2.0))
                offers.append((stamp, latest, current))
    good = [(s, c) for s, at, c in offers if np.isfinite(c) and s <= at and (s == at or not lockstep)]
    newest = max((s for s, _ in good), default=None)
    expected = next((c for s, c in good if s == newest), None)
    assert exchange.currents.tolist() == ([1.0, 1.0] if expected is None else [expected, 2.0])
    judged = sum(exchange.counts.values()) - exchange.counts["saturated"]
    assert judged == len(offers)
