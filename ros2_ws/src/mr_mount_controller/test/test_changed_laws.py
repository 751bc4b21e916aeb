"""Laws whose parameters change during a run: what goes on, what begins anew, what is refused."""

import numpy as np
import pytest
from mr_mount_controller.laws import find_law, known_laws
from mr_mount_controller.laws.base import ControlLaw, Sample
from mr_mount_controller.laws.running import answer, changed_law
from mr_mount_controller.mounting import PAIR
from mr_mount_controller.node_base.parameters import Parameter, ParameterError

pytestmark = pytest.mark.property

PERIOD = 1e-3


def samples(count, seed=1):
    """Samples with every channel random."""
    random = np.random.default_rng(seed)
    for k in range(count):
        values = 3.0 * random.normal(size=(4, 3))
        values[::2, 2] += 9.81
        yield Sample((k + 1) * PERIOD, *(tuple(row) for row in values.tolist()))


class Counting(ControlLaw):
    """A user's law: prepares in `__init__` what follows from its parameter, and remembers."""

    parameters = (Parameter("step", 0.1, "Current a sample.", "A", 0.0, 1.0),)

    def __init__(self, period, **values):
        super().__init__(period, **values)
        if self.step == 0.5:
            raise ZeroDivisionError("half")
        self.twice = 2.0 * self.step

    def reset(self):
        self.count = 0

    def update(self, sample):
        self.count += 1
        return self.count * self.twice


@pytest.mark.parametrize("name", known_laws())
def test_every_law_takes_every_parameter(name):
    """Half of the way to either bound or, where that is refused, with one clear sentence; the answer is a current."""
    law = find_law(name)(PERIOD)
    law.run_on(PAIR)
    given = list(samples(40))
    for sample in given[:20]:
        answer(law, sample)
    for parameter in law.parameters:
        value = 0.5 * (getattr(law, parameter.name) + parameter.high)
        try:
            changed = changed_law(law, {parameter.name: value})
        except ParameterError as error:
            assert parameter.name in str(error)
            continue
        assert getattr(changed, parameter.name) == value
        assert all(np.isfinite(answer(changed, sample)).all() for sample in given[20:])


def test_a_law_without_a_word_of_its_own_begins_anew():
    """What its `__init__` prepares follows the new value; memory is as after a reset."""
    law = Counting(PERIOD)
    law.run_on(PAIR)
    assert [answer(law, sample)[0] for sample in samples(2)] == [0.2, 0.4]
    changed = changed_law(law, {"step": 0.25})
    assert answer(changed, next(samples(1)))[0] == 0.5
    assert changed.mounting == law.mounting


def test_skyhook_keeps_the_estimated_motion():
    """After the change it answers as one that had the new currents all the time; not with another corner."""
    before, all_along = find_law("skyhook")(PERIOD), find_law("skyhook")(PERIOD, firm_current=2.0)
    given = list(samples(600))
    for sample in given[:300]:
        before.update(sample), all_along.update(sample)
    after = changed_law(before, {"firm_current": 2.0})
    assert [after.update(sample) for sample in given[300:]] == [all_along.update(sample) for sample in given[300:]]
    assert changed_law(after, {"corner": 1.0})._estimator is not after._estimator


def test_what_does_not_go_together_is_refused():
    """The law that runs is left as it is, whatever the new one raises."""
    law = find_law("skyhook")(PERIOD, firm_current=2.0)
    with pytest.raises(ParameterError, match="accepted: at most firm_current, 2 A"):
        changed_law(law, {"soft_current": 2.5})
    assert law.soft_current == 0.8
    with pytest.raises(ParameterError, match="Counting cannot take .*ZeroDivisionError: half"):
        changed_law(Counting(PERIOD), {"step": 0.5})
