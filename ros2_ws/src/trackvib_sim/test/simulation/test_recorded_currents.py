"""Which current was in force in a recorded run: the coils decide where the messages do not."""

from itertools import islice
from types import SimpleNamespace

import numpy as np
import pytest
from trackvib_sim.bags.recording import Answers, LoopCounts
from trackvib_sim.road.bump import Bump
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.simulation.recorded_currents import NotTold, currents_in_force
from trackvib_sim.simulation.simulation import HORIZON

pytestmark = pytest.mark.property

PERIOD = 1_000_000  # ns
PERIODS = 60
NO_WORD = np.zeros((0, 3), dtype=np.int64)  # stamp, silent periods, answers


def recorded(simulation, currents, answers, loop_counts=NO_WORD):
    """Drive with currents (k, 2) in force, and return what a bag with these answers (number of sample, A) tells."""
    lay_road(simulation)
    seen = []
    for current in currents:
        simulation.advance(current)
        seen.append(simulation.sample.mounts.current.copy())
    simulation.reset()
    stamps = np.arange(1, len(seen) + 1) * PERIOD
    return SimpleNamespace(
        answers=Answers(
            np.array([number * PERIOD for number, _ in answers], dtype=np.int64),
            np.array([current for _, current in answers]).reshape(-1, 2),
        ),
        mounts=SimpleNamespace(stamp=stamps, current=np.array(seen)),
        loop_counts=LoopCounts(*loop_counts.T),
    )


def lay_road(simulation):
    """Give a simulation level road."""
    for patch in RoadFeeder(Bump(0.0, 1.0, 0.0), HORIZON).patches(0.0):
        simulation.road.add(patch[0], patch[1], *patch[2])


def driven(simulation, drive, on_silence="hold"):
    """Drive again, and yield the currents in force period by period."""
    lay_road(simulation)
    for current in islice(currents_in_force(simulation, drive, on_silence), PERIODS):
        yield current
        simulation.advance(current)


def in_force(simulation, drive, on_silence="hold"):
    """Return the currents of all periods (k, 2); the simulation is as before."""
    currents = np.array(list(driven(simulation, drive, on_silence)))
    simulation.reset()
    return currents


@pytest.fixture
def drawn():
    """Currents in force (k, 2), the first the passive one."""
    return np.vstack((np.ones(2), np.random.default_rng(3).uniform(0.7, 4.0, (PERIODS - 1, 2))))


@pytest.fixture(params=[0.0, 0.0023], ids=["at once", "delayed"])
def vehicle_with(request, changed):
    """The vehicle with a driver that acts at once, and with one that thinks for more than two periods."""
    return changed("coil", delay=request.param)


def test_of_two_answers_the_one_that_acted(simulation, vehicle_with, drawn):
    """In whichever order they lie in the bag."""
    one = simulation(5.0, vehicle=vehicle_with)
    other = np.random.default_rng(4).uniform(0.7, 4.0, drawn.shape)
    answers = []
    for number in range(1, PERIODS):
        both = [(number, drawn[number]), (number, other[number])]
        answers += both if number % 2 else both[::-1]
    drive = recorded(one, drawn, answers)
    found = in_force(one, drive)
    seen = PERIODS - 3  # the last ones show in no recorded current yet
    # what makes no difference, since the driver's voltage is at its limit, need not be told apart
    np.testing.assert_array_equal(recorded(one, found, []).mounts.current[:seen], drive.mounts.current[:seen])
    assert np.mean(found[:seen] == drawn[:seen]) > 0.8


@pytest.mark.parametrize(("on_silence", "instead"), [("hold", None), ("passive", 1.0)])
def test_late_answers_do_not_act(simulation, drawn, on_silence, instead):
    """From sample 20 to 39 the answers came too late, which the simulator told as silent periods."""
    one, answers = simulation(5.0), [(number, drawn[number]) for number in range(1, PERIODS)]
    acted = drawn.copy()
    acted[20:40] = drawn[19] if instead is None else instead
    loop_counts = np.array([[10 * PERIOD, 0, 9], [20 * PERIOD, 1, 19], [50 * PERIOD, 20, 50]])
    found = in_force(one, recorded(one, acted, answers, loop_counts), on_silence)
    np.testing.assert_array_equal(found, acted)


def test_answers_that_are_no_currents_never_act(simulation, drawn):
    """NaN is none, and leaves the sample to the next answer."""
    one = simulation(5.0)
    answers = [(number, current) for number in range(1, PERIODS) for current in ((np.nan, 1.0), drawn[number])]
    np.testing.assert_array_equal(in_force(one, recorded(one, drawn, answers)), drawn)


@pytest.mark.parametrize(
    "loop_counts", [NO_WORD, np.array([[20 * PERIOD, 0, 19], [40 * PERIOD, 0, 39]]), np.array([[40 * PERIOD, 1, 40]])]
)
def test_a_missing_answer_is_named(simulation, drawn, loop_counts):
    """Where no silence was told, or more answers than are recorded, the current is unknown from there on."""
    one, answers = simulation(5.0), [(number, drawn[number]) for number in range(1, PERIODS) if number != 30]
    currents = driven(one, recorded(one, drawn, answers, loop_counts))
    for k in range(30):
        np.testing.assert_array_equal(next(currents), drawn[k])
    with pytest.raises(NotTold, match=r"sample at t = 0.030 s"):
        next(currents)
