"""What few runs tell of all that could be made: deviations of samples, and how sure a mean is."""

import numpy as np
from scipy.stats import t as student

CONFIDENCE = 0.95


def deviation(values):
    """Return the sample standard deviation along the first axis, (n, ...) -> (...); not a number of a single one."""
    values = np.asarray(values, dtype=float)
    return values.std(axis=0, ddof=1) if len(values) > 1 else np.full(values.shape[1:], np.nan)


def half_interval(values):
    """Return half of the interval that holds the mean of (n,) normal values by `CONFIDENCE`, by Student's t."""
    n = len(values)
    if n < 2:
        return np.nan
    return float(student.ppf(0.5 + 0.5 * CONFIDENCE, n - 1) * deviation(values) / np.sqrt(n))
