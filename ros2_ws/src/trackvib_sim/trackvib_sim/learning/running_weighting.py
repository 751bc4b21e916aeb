"""A frequency weighting of [ISO2631-1] sample by sample, as a reward needs it."""

from scipy.signal import sosfilt_zi

from ..analysis.iso2631 import weighting_filter


class RunningWeighting:
    """Weights one number a sample, as if the first one had lasted for ever before.

    Parameters
    ----------
    name : str
        "Wk", "Wd" or "Wf".
    rate : float
        Sampling rate [Hz].
    """

    def __init__(self, name, rate):
        sections = weighting_filter(name, rate)
        self._sections = [(row[:3].tolist(), row[4:].tolist()) for row in sections]
        self._steady = sosfilt_zi(sections).tolist()  # states under a constant input of one
        self._states = None

    def update(self, value):
        """Return the weighted value after the next one."""
        if self._states is None:
            self._states = [[value * z1, value * z2] for z1, z2 in self._steady]
        for state, ((b0, b1, b2), (a1, a2)) in zip(self._states, self._sections, strict=True):
            before, value = value, b0 * value + state[0]
            state[0] = b1 * before - a1 * value + state[1]
            state[1] = b2 * before - a2 * value
        return value
