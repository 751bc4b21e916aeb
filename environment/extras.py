"""What only some verbs need: packages that are installed at the first use."""

from pathlib import Path
from typing import NamedTuple

from environment.places import Places


class Extra(NamedTuple):
    """Packages by a lock of their own, `requirements-NAME.lock`, added to the environment."""

    name: str
    what: str  # what they are, in the words of the set-up
    python: tuple  # the first Python that there are packages for

    def lock(self, places: Places) -> Path:
        """All its packages, pinned, but those that the environment has without it."""
        return places.environment / f"requirements-{self.name}.lock"

    def folder(self, places: Places) -> Path:
        """The folder of its stage; within the environment, so that it goes with it."""
        return places.venv / f"extra_{self.name}"


STUDIES = Extra("studies", "the independent engine", (3, 10))
TESTS = Extra("tests", "the test tools", (3, 10))
GYM = Extra("gym", "the interface of learning environments", (3, 10))
FMU = Extra("fmu", "the packer of FMUs", (3, 10))
VIEW = Extra("view", "the viewer", (3, 11))
DOCS = Extra("docs", "the generator of the documentation site", (3, 10))
EXTRAS = (STUDIES, TESTS, GYM, FMU, VIEW, DOCS)
_WHOLE = {"docs": (DOCS,), "fmu": (FMU,)}  # verbs that cannot do without


def wanted(verb: str, arguments: list) -> tuple:
    """Return the `Extra`s that a verb needs with these arguments."""
    options = {word.split("=")[0] for word in arguments}
    if verb == "setup":
        return tuple(extra for extra in EXTRAS if f"--{extra.name}" in options)
    if verb == "test":
        return (STUDIES, TESTS, GYM, FMU)
    if options & {"-h", "--help"}:
        return ()
    if verb == "study" and arguments[:1] == ["figures"]:
        return (STUDIES,)
    if (verb == "view" and "--gif" not in options) or (verb == "run" and "--view" in options):
        return (VIEW,)
    return _WHOLE.get(verb, ())
