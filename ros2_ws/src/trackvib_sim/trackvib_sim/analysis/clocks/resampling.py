"""Band-limited resampling: a sensor's samples as they would have been at the instants of another.

Samples are put twice as dense by a low-pass of 193 taps (flat to 0.47 of the rate, images 80 dB down), through these
goes a spline of fifth degree: up to 0.4 of the rate amplitudes are kept within 0.1 %, phases exactly. In blocks, into
an unnamed temporary file: recordings may be long.
"""

from tempfile import TemporaryFile

import numpy as np
from scipy import ndimage, signal

from ..stamps import blocks

DENSER = 2
REACH = 48  # samples to either side that a value comes from
MARGIN = 2 * REACH + 32  # samples about a block, after which low-pass and spline have forgotten its ends
BLOCK = 200_000  # samples
_ORDER = 5  # of the spline
_WINDOW = ("kaiser", 8.0)


def resampled(values, place, ratio=1.0):
    """Return what evenly sampled values are at places between the samples.

    Parameters
    ----------
    values : (k, m) array
        Without a gap.
    place : (n,) array
        Rising, in samples from the first: 0 to k - 1.
    ratio : float
        Of the new rate to that of the values; below 1 all above half the new rate is taken out before.

    Returns
    -------
    (n, m) array
        Mapped from a temporary file, as a recording's columns are.
    """
    reach = round(REACH / min(ratio, 1.0))
    shape, margin = (len(place), values.shape[1]), MARGIN - REACH + reach
    if not len(place):
        return np.empty(shape)
    found = np.memmap(TemporaryFile(), float, shape=shape)  # lives as long as the array  # noqa: SIM115
    low_pass = signal.firwin(2 * DENSER * reach + 1, min(ratio, 1.0) / DENSER, window=_WINDOW)
    for block in blocks(len(place), BLOCK):
        first = max(int(place[block.start]) - margin, 0)
        last = min(int(place[block.stop - 1]) + margin + 1, len(values))
        # mirrored at the ends of the recording, where nothing is known of what comes next
        around = np.pad(np.array(values[first:last]), ((margin, margin), (0, 0)), mode="symmetric")
        dense = signal.resample_poly(around, DENSER, 1, window=low_pass)
        at = DENSER * (place[block] - first + margin)
        for column in range(shape[1]):
            coefficients = ndimage.spline_filter1d(dense[:, column], _ORDER, mode="mirror")
            found[block, column] = ndimage.map_coordinates(coefficients, [at], order=_ORDER, prefilter=False)
    return found
