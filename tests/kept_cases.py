"""Finished cases of studies, kept for the tests of a session: what one has driven, another does not drive again.

The studies' own rule says which of them count: a file's name holds a hash of the vehicle and of the program.
"""

import os
import shutil

STORES = ("cases", "left_out")  # folders of a study's finished cases


class KeptCases:
    """Cases below a folder that all workers of a test run share."""

    def __init__(self, folder):
        self._folder = folder

    def keep(self, study, name):
        """Keep what a study of a name has left in its folder."""
        _copy(study, self._folder / name, STORES)

    def give(self, study, name, stores=STORES):
        """Put what is kept of a study and lacks in its folder there, as if it had been interrupted."""
        _copy(self._folder / name, study, stores)


def _copy(source, target, stores):
    for file in sorted(file for store in stores for file in (source / store).rglob("*.json")):
        copy = target / file.relative_to(source)
        if copy.exists():
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        draft = copy.with_suffix(f".{os.getpid()}")
        shutil.copyfile(file, draft)
        draft.rename(copy)  # whole, for whoever reads at the time
