"""Patches of road as they come from a bag: heights lie in a temporary file, as columns do."""

from tempfile import TemporaryFile

import numpy as np


class RoadPatches:
    """Patches (start, spacing, left, right) [m], each with its heights (n,) and (m,)."""

    def __init__(self):
        self._file = TemporaryFile()  # noqa: SIM115, lives as long as the arrays
        self._patches, self._written = [], 0  # heights

    def add(self, start, spacing, left, right):
        """Add a patch behind the others."""
        for heights in (left, right):
            self._file.write(np.ascontiguousarray(heights, np.float64).data)
        self._patches.append((start, spacing, self._written, len(left), len(right)))
        self._written += len(left) + len(right)

    def __len__(self):
        return len(self._patches)

    def __iter__(self):
        self._file.flush()
        heights = np.memmap(self._file, np.float64, "r") if self._written else np.empty(0)
        for start, spacing, begin, left, right in self._patches:
            middle = begin + left
            yield start, spacing, heights[begin:middle], heights[middle : middle + right]
