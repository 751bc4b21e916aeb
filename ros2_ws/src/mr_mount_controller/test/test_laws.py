"""Control laws: the contract that every installed law keeps, skyhook's rule, and what an answer may be."""

import doctest

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mr_mount_controller.laws import base, find_law, known_laws, shipped_laws
from mr_mount_controller.laws.base import ControlLaw, LawError, Sample
from mr_mount_controller.laws.passive import Passive
from mr_mount_controller.laws.running import answer
from mr_mount_controller.laws.skyhook import Skyhook
from mr_mount_controller.mount import HIGHEST_CURRENT, LOWEST_CURRENT
from mr_mount_controller.mounting import PAIR, Kind, Mount, Mounting, undescribed
from mr_mount_controller.node_base.parameters import ParameterError

PERIOD = 1e-3
FINITE = st.floats(allow_nan=False, allow_infinity=False)
ALL_LAWS = pytest.mark.parametrize("name", known_laws())


def noise(seed, count=300):
    """Samples with every channel random."""
    random = np.random.default_rng(seed)
    for k in range(count):
        values = 10.0 * random.normal(size=(4, 3))
        values[::2, 2] += 9.81
        yield Sample((k + 1) * PERIOD, *(tuple(row) for row in values.tolist()))


def currents(law, seed):
    """All answers to a sequence of samples."""
    return np.array([answer(law, sample) for sample in noise(seed)])


@pytest.mark.property
def test_shipped_laws_are_known():
    """The laws of this package are found by their names."""
    shipped = {"passive", "skyhook", "continuous_skyhook", "groundhook", "hybrid", "acceleration_driven",
               "mixed_skyhook_add", "clipped_optimal", "engine_order"}  # fmt: skip
    assert shipped <= set(known_laws())
    assert find_law("passive") is Passive
    assert find_law("mr_mount_controller.laws.skyhook:Skyhook") is Skyhook


@pytest.mark.property
@ALL_LAWS
@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_same_samples_give_the_same_currents(name, seed):
    """Two instances answer the same samples alike, to the last bit, finite."""
    first, second = (currents(find_law(name)(PERIOD), seed) for _ in range(2))
    assert first.tobytes() == second.tobytes()
    assert np.isfinite(first).all()


@pytest.mark.property
@ALL_LAWS
def test_reset_makes_a_law_as_new(name):
    """After other samples and a reset, a law answers as one just made."""
    used = find_law(name)(PERIOD)
    currents(used, 1)
    used.reset()
    assert currents(used, 2).tobytes() == currents(find_law(name)(PERIOD), 2).tobytes()


@pytest.mark.property
@ALL_LAWS
def test_parameters_are_acceptable_and_arrive(name):
    """Every default passes its own check, and a value given at the start is the law's attribute."""
    law = find_law(name)
    assert len({parameter.name for parameter in law.parameters}) == len(law.parameters)
    for parameter in law.parameters:
        assert parameter.check(parameter.default) == parameter.default
        assert getattr(law(PERIOD), parameter.name) == parameter.default
    highest = {parameter.name: parameter.high for parameter in law.parameters if parameter.high is not None}
    given_all = law(PERIOD, **highest)
    assert all(getattr(given_all, key) == value for key, value in highest.items())


@pytest.mark.property
@ALL_LAWS
@pytest.mark.parametrize("end", ["low", "high"])
def test_laws_run_at_the_ends_of_their_parameters(name, end):
    """With every number at one end of its range the answers are finite all the same."""
    law = find_law(name)
    ranged = [parameter for parameter in law.parameters if parameter.low is not None]
    values = {parameter.name: parameter.check(getattr(parameter, end)) for parameter in ranged}
    assert np.isfinite(currents(law(PERIOD, **values), 3)).all()


@pytest.mark.property
@pytest.mark.parametrize("period", [1e-4, 1e-3, 0.1])
@pytest.mark.parametrize("name", shipped_laws())
@settings(max_examples=10)
@given(samples=st.lists(st.tuples(*[st.tuples(*[FINITE] * 3)] * 4), max_size=20))
def test_any_samples_give_currents_that_mounts_can_use(name, period, samples):
    """During and after any finite samples, at any rate, the current is within the range that the mounts use."""
    law = find_law(name)(period)
    rest = ((0.0, 0.0, 9.81), (0.0, 0.0, 0.0)) * 2
    for k, values in enumerate([*samples, *[rest] * 30]):
        current = answer(law, Sample((k + 1) * period, *values))
        assert (current >= LOWEST_CURRENT).all() and (current <= HIGHEST_CURRENT).all()


@pytest.mark.property
@pytest.mark.parametrize("name", [name for name in shipped_laws() if name != "passive"])
def test_soft_is_not_firmer_than_firm(name):
    """Currents the wrong way round are refused with both."""
    with pytest.raises(ParameterError, match=r"'soft_current' is 3.0, accepted: at most firm_current, 2 A"):
        find_law(name)(PERIOD, soft_current=3.0, firm_current=2.0)


@pytest.mark.property
def test_passive_holds_its_current():
    """Passive answers its current whatever the sample."""
    assert (currents(Passive(PERIOD, current=1.7), 4) == 1.7).all()


@pytest.mark.property
def test_example_of_the_contract_runs():
    """The example in the contract gives what it says."""
    result = doctest.testmod(base)
    assert result.attempted >= 4 and result.failed == 0


class Says(ControlLaw):
    """Answers whatever it is told to."""

    says = None

    def update(self, sample):
        """Return it."""
        return self.says


def _saying(what):
    law = Says(PERIOD)
    law.says = what
    return law


@pytest.mark.property
@pytest.mark.parametrize(
    ("given_answer", "expected"),
    [(1, [1, 1]), (1.5, [1.5, 1.5]), ((1, 2.5), [1, 2.5]), (np.float32(2), [2, 2]), (np.array([3, -4]), [3, -4])],
)
def test_answers_are_one_current_or_one_a_coil(sample, given_answer, expected):
    """One number serves all coils, as many as there are coils are theirs, out of any usual type."""
    assert answer(_saying(given_answer), sample(0.0)).tolist() == expected


@pytest.mark.property
@pytest.mark.parametrize("coils", [0, 1, 3, 4, 16])
def test_answers_are_of_the_number_of_coils(sample, coils):
    """One number goes to all; another number of numbers than coils is refused with both."""
    one, each = _saying(1.5), _saying([float(k) for k in range(coils)])
    for law in (one, each):
        law.run_on(undescribed(coils))
    assert answer(one, sample(0.0)).tolist() == [1.5] * coils
    assert answer(each, sample(0.0)).tolist() == list(range(coils))
    each.says = [1.0] * (coils + 2)
    with pytest.raises(LawError, match=f"one finite current .A., or {coils} of them"):
        answer(each, sample(0.0))


@pytest.mark.property
@pytest.mark.parametrize("name", shipped_laws())
@pytest.mark.parametrize("coils", [0, 1, 4, 16])
def test_laws_answer_any_number_of_coils(name, coils):
    """With mounts anywhere: as many currents, in the range that mounts use, also from a law that was used before."""
    random = np.random.default_rng(coils)
    mounts = [Mount(f"mount {k}", Kind.MR, tuple(random.uniform(-1.0, 1.0, 3).tolist())) for k in range(coils)]
    mounting = Mounting((*mounts, Mount("pad", Kind.RUBBER, (-1.0, 0.0, 0.0))))
    fresh, used = find_law(name)(PERIOD), find_law(name)(PERIOD)
    currents(used, 1)
    for law in (fresh, used):
        law.run_on(mounting)
    found = currents(fresh, 2)
    assert found.shape == (300, coils)
    assert (found >= LOWEST_CURRENT).all() and (found <= HIGHEST_CURRENT).all()
    assert found.tobytes() == currents(used, 2).tobytes()


@pytest.mark.property
@pytest.mark.parametrize("name", shipped_laws())
def test_mounts_side_by_side_of_a_hinged_powertrain_get_the_same(name):
    """What cannot turn does not tell them apart; nor are the answers others than those to the pair, to the last bit."""
    law, pair = find_law(name)(PERIOD), find_law(name)(PERIOD)
    law.run_on(Mounting((Mount("a", Kind.MR, (0.0, 0.3, 0.1)), Mount("b", Kind.MR, (0.0, -0.7, 0.0))), PAIR.turning))
    found = currents(law, 5)
    assert (found[:, 0] == found[:, 1]).all()
    assert found.tobytes() == currents(pair, 5).tobytes()


@pytest.mark.property
@pytest.mark.parametrize(
    "bad",
    [None, float("nan"), float("inf"), (1.0, float("nan")), "text", "2.0", ("1", "2"), b"3", True, 1j, {1.0},
     (1.0, 2.0, 3.0), (), ([1.0], [2.0]), np.ones((1, 2)), 10**400, {"current": 1.0}],
)  # fmt: skip
def test_other_answers_are_refused(sample, bad):
    """Anything else is refused with the law's name, the answer, the time and what is wanted."""
    with pytest.raises(LawError) as refused:
        answer(_saying(bad), sample(1.25))
    for words in ("law Says", repr(bad), "t = 1.250 s", "one finite current [A], or 2 of them"):
        assert words in str(refused.value)


@pytest.mark.property
@pytest.mark.parametrize(
    "name",
    ["", "nope", "json:", ":X", ".law:X", "no_such_module:Law", "json:NoSuchLaw", "json:dumps", "fractions:Fraction"],
)
def test_unknown_laws_are_refused_by_name(name):
    """A law that is not there, or is none, is refused in a sentence that names it."""
    with pytest.raises(ParameterError) as refused:
        find_law(name)
    assert f"'law' is {name!r}" in str(refused.value)


@pytest.mark.property
@pytest.mark.parametrize("text", ["1 / 0", "raise SystemExit", "law (", "raise KeyError", "def f(): f()\nf()"])
def test_a_law_whose_module_fails_is_refused(tmp_path, monkeypatch, text):
    """Whatever it raises when it is loaded, the error names the law."""
    (tmp_path / "failing_law.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ParameterError, match="'failing_law:Law', which cannot be loaded: [A-Z]"):
        find_law("failing_law:Law")
