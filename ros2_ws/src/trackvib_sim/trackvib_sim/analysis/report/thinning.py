"""Long signals made light: few enough points for a browser, with every peak still there. In blocks, as `levels`."""

import numpy as np

from ..stamps import BLOCK, blocks

MOST = 8000  # points of a line, more than any screen has columns


def thinned(time, values, longest_step, most=MOST):
    """Return time and values (n,) of a line through samples (k,), as 32-bit numbers, about `most` of them.

    Of many samples the least and the greatest of each of equal parts are kept, at their own times, and the first and
    the last. Where the time steps by more than `longest_step` [s] the line is broken by a nan.
    """
    kept = _extremes(values, most) if len(values) > most else np.arange(len(values))
    gaps = [np.empty(0, np.int64)]
    for block in blocks(len(values) - 1, BLOCK):
        gaps.append(block.start + np.flatnonzero(np.diff(time[block.start : block.stop + 1]) > longest_step))
    # a gap lies between the last kept sample that is not beyond it and the next one
    broken = np.unique(np.searchsorted(kept, np.concatenate(gaps), side="right"))
    line = [np.insert(np.asarray(each[kept]).astype(np.float32), broken, np.nan) for each in (time, values)]
    return line[0], line[1]


def _extremes(values, most):
    width = -(-2 * len(values) // most)
    kept = [[0, len(values) - 1]]
    for block in blocks(len(values), max(BLOCK // width, 1) * width):
        within = np.asarray(values[block])
        whole = len(within) // width * width
        parts, begin = within[:whole].reshape(-1, width), block.start + np.arange(0, whole, width)
        kept += [begin + parts.argmin(axis=1), begin + parts.argmax(axis=1)]
        if rest := within[whole:].size:
            last = block.stop - rest
            kept.append([last + within[whole:].argmin(), last + within[whole:].argmax()])
    return np.unique(np.concatenate(kept))
