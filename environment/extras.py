"""What only some verbs need: packages in a folder of their own, installed at the first use."""

from pathlib import Path
from typing import NamedTuple

from environment.places import Places


class Extra(NamedTuple):
    """Packages beside the environment, by a lock of their own: `requirements-NAME.lock`."""

    name: str
    what: str  # what they are, in the words of the set-up
    python: tuple  # the first Python that there are packages for

    def lock(self, places: Places) -> Path:
        """All its packages, pinned, but those that the environment has."""
        return places.environment / f"requirements-{self.name}.lock"

    def folder(self, places: Places) -> Path:
        """The folder of its stage."""
        return places.home / self.name

    def packages(self, places: Places) -> Path:
        """Where its packages lie."""
        return self.folder(places) / "packages"


VIEW = Extra("view", "the viewer", (3, 11))
DOCS = Extra("docs", "the generator of the documents' site", (3, 10))
EXTRAS = (VIEW, DOCS)


def wanted(verb: str, arguments: list) -> tuple:
    """Return the `Extra`s that a verb needs with these arguments."""
    options = {word.split("=")[0] for word in arguments}
    if verb == "setup":
        return tuple(extra for extra in EXTRAS if f"--{extra.name}" in options)
    if options & {"-h", "--help"}:
        return ()
    if verb == "docs":
        return (DOCS,)
    shows = (verb == "view" and "--gif" not in options) or (verb == "run" and "--view" in options)
    return (VIEW,) if shows else ()
