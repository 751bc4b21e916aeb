"""Where numbers lie in memory."""

from typing import NamedTuple

import numpy as np
import pytest
from trackvib_sim.rui.sweeps.cells import CACHE_LINE, copy_cells, new_cells

pytestmark = pytest.mark.property


class _Pair(NamedTuple):
    cells: np.ndarray
    inner: tuple


def _beside(array):
    """Bytes from a cache line to the array."""
    return array.ctypes.data % CACHE_LINE


@pytest.mark.parametrize("first", [0, 1, 7])
def test_chosen_cell_begins_a_cache_line(first):
    """Whichever cell of the first block that is."""
    cells = new_cells(2, 24, first)
    assert _beside(cells[0, first:]) == 0 and not cells.any()


def test_copies_share_nothing_but_their_place_on_the_cache_lines():
    """A copy of a record of records has the same numbers, and is written to alone."""
    inner = _Pair(np.arange(5)[1:], _Pair(np.zeros((0, 3)), np.array([True])))
    record = _Pair(new_cells(2, 9, first=1), inner)
    record.cells[:] = 1.0
    copy = copy_cells(record)
    pairs = [
        (copy.cells, record.cells),
        (copy.inner.cells, inner.cells),
        (copy.inner.inner.cells, inner.inner.cells),
        (copy.inner.inner.inner, inner.inner.inner),
    ]
    for ours, theirs in pairs:
        np.testing.assert_array_equal(ours, theirs)
        assert ours.dtype == theirs.dtype and not np.shares_memory(ours, theirs)
        assert ours.size == 0 or _beside(ours) == _beside(theirs)
    copy.cells[:] = 2.0
    assert (record.cells == 1.0).all()
