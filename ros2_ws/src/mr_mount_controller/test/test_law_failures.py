"""A law whose own code fails: one sentence with its name, the time, file and line, and what it says, as signs."""

import importlib
from pathlib import Path

import pytest
from mr_mount_controller.laws import LawError, find_law
from mr_mount_controller.laws.running import answer, law_code, make_law, run_law_on
from mr_mount_controller.mounting import PAIR
from mr_mount_controller.node_base.parameters import ParameterError

pytestmark = pytest.mark.property

CODE = """
from mr_mount_controller.laws import ControlLaw


def helper():
    raise ValueError("bad \\x1b[31m\\nthing")  # line 6


class Helped(ControlLaw):
    def update(self, sample):
        helper()


class Derived(Helped):
    pass


class Silent(ControlLaw):
    def update(self, sample):
        raise KeyError  # line 20


class Speechless(Exception):
    def __str__(self):
        raise RuntimeError


class Mute(ControlLaw):
    def update(self, sample):
        raise Speechless  # line 30


class Exits(ControlLaw):
    def update(self, sample):
        raise SystemExit(0)  # line 35


class Library(ControlLaw):
    def update(self, sample):
        return min(map(int, ["x"]))  # line 40


class Shape(ControlLaw):
    def update(self):  # line 44
        return 1.0


class Nan(ControlLaw):
    def update(self, sample):  # line 49
        return float("nan")


class Hostile:
    def __repr__(self):
        raise RuntimeError

    def __len__(self):
        raise ZeroDivisionError


class Odd(ControlLaw):
    def update(self, sample):  # line 62
        return Hostile()


class Unmade(ControlLaw):
    def reset(self):
        1 / 0  # line 68


class Unset(ControlLaw):
    def run_on(self, mounting):
        1 / 0  # line 73
"""
SAID = {
    "Helped": "failed at t = 1.250 s: ValueError: bad \\x1b[31m\\nthing (FILE, line 6)",
    "Derived": "failed at t = 1.250 s: ValueError: bad \\x1b[31m\\nthing (FILE, line 6)",
    "Silent": "failed at t = 1.250 s: KeyError (FILE, line 20)",
    "Mute": "failed at t = 1.250 s: Speechless (FILE, line 30)",
    "Exits": "failed at t = 1.250 s: SystemExit: 0 (FILE, line 35)",
    "Library": "failed at t = 1.250 s: ValueError: invalid literal for int() with base 10: 'x' (FILE, line 40)",
    "Nan": "answered nan at t = 1.250 s (FILE, line 49), must be one finite current [A], or 2 of them, one per coil",
    "Odd": "answered a Hostile at t = 1.250 s (FILE, line 62), must be one finite current [A], or 2 of them, "
    "one per coil",
}


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """The file of such laws, importable."""
    path = tmp_path_factory.mktemp("laws") / "laws_that_fail.py"
    path.write_text(CODE)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(path.parent)
        importlib.invalidate_caches()
        yield path


@pytest.mark.parametrize(("name", "words"), SAID.items())
def test_a_law_that_fails_at_a_sample(file: Path, sample, name, words):
    """The line is the innermost in its own file, wherever the exception comes from."""
    law = make_law(find_law(f"laws_that_fail:{name}"), 1e-3, {})
    with pytest.raises(LawError) as failed:
        answer(law, sample(1.25))
    assert str(failed.value) == f"law {name} {words}".replace("FILE", str(file))


def test_a_law_that_cannot_be_called(file, sample):
    """Nothing of it has run: the line is where `update` begins."""
    with pytest.raises(LawError, match=rf"^law Shape failed .*takes 1 positional.* \({file}, line 44\)$"):
        answer(make_law(find_law("laws_that_fail:Shape"), 1e-3, {}), sample(1.25))


def test_a_law_that_cannot_begin(file):
    """In its constructor it is refused as values are; on the mounts, or when it is reset, it fails."""
    with pytest.raises(
        ParameterError, match=rf"^law Unmade cannot be made: ZeroDivisionError: .* \({file}, line 68\)$"
    ):
        make_law(find_law("laws_that_fail:Unmade"), 1e-3, {})
    law = make_law(find_law("laws_that_fail:Unset"), 1e-3, {})
    with pytest.raises(LawError, match=r"^law Unset failed at its start: .*line 73\)$"):
        run_law_on(law, PAIR)
    with pytest.raises(LawError, match="^law Unset failed when it slept: OSError: no"), law_code(law, "when it slept"):
        raise OSError("no")


def test_the_origin_is_kept(file, sample):
    """For whoever wants the whole traceback."""
    with pytest.raises(LawError) as failed:
        answer(make_law(find_law("laws_that_fail:Helped"), 1e-3, {}), sample(1.25))
    assert type(failed.value.__cause__) is ValueError


@pytest.mark.parametrize(
    ("name", "meant"), [("skyhok", "skyhook"), ("Passive", "passive"), ("laws_that_fail:Helpt", "Helped")]
)
def test_a_name_that_is_nearly_right(file, name, meant):
    """The error suggests what may have been meant."""
    with pytest.raises(ParameterError, match=rf"\. Did you mean '{meant}'\?$"):
        find_law(name)
