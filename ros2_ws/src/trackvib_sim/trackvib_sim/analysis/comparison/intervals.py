"""Levels over windows and the confidence interval of their ratio, by the jackknife.

The windows of each drive are cut into up to 20 groups in their order of time, so that what follows closely upon each
other stays together. The scatter of the logarithm of a level with one group left out gives its standard error, with one
degree of freedom less than there are groups; both drives together have those of Welch and Satterthwaite, and the
interval is Student's, on the logarithm of the ratio.
"""

import numpy as np
from scipy import stats

CONFIDENCE = 0.95
GROUPS = 20
LEAST_GROUPS = 3  # fewer tell no scatter


def jackknifed(columns, stratum, weights, derive):
    """Return logarithms of quantities (k,), their standard errors (k,), nan of too few windows, and the groups.

    Parameters
    ----------
    columns : (n, m) array
        Of each window what is averaged.
    stratum : (n,) int
        In which of s strata it lies.
    weights : (s,) array
        Of the strata, with which their means are averaged.
    derive : callable
        Turns averages (g, m) into logarithms of quantities (g, k).
    """
    groups = min(GROUPS, len(columns))
    group = np.arange(len(columns)) * groups // len(columns)
    cell = group * len(weights) + stratum
    count = np.bincount(cell, minlength=groups * len(weights)).reshape(groups, -1).astype(float)
    total = np.zeros((groups * len(weights), columns.shape[1]), columns.dtype)
    np.add.at(total, cell, columns)
    total = total.reshape(groups, len(weights), -1)
    whole = derive(_average(total.sum(axis=0)[None], count.sum(axis=0)[None], weights))[0]
    if groups < LEAST_GROUPS:
        return whole, np.full(whole.shape, np.nan), groups
    without = derive(_average(total.sum(axis=0) - total, count.sum(axis=0) - count, weights))
    scatter = np.square(without - without.mean(axis=0)).sum(axis=0)
    return whole, np.sqrt((groups - 1) / groups * scatter), groups


def _average(total, count, weights):
    """Return averages (g, m) of the means in strata, of those that are not empty."""
    used = np.where(count > 0.5, weights, 0.0)
    share = used / used.sum(axis=1, keepdims=True) / np.maximum(count, 1.0)
    return np.einsum("gs,gsm->gm", share, total)


def ratio_interval(first, second):
    """Return the ratio (k,) of the second to the first, and its interval (k,), (k,), of two results of `jackknifed`."""
    (level, error, groups), (other, other_error, other_groups) = first, second
    ratio, squares = other - level, (error**2, other_error**2)
    below = squares[0] ** 2 / max(groups - 1, 1) + squares[1] ** 2 / max(other_groups - 1, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = np.where(below > 0.0, (squares[0] + squares[1]) ** 2 / below, min(groups, other_groups) - 1)
        reach = stats.t.ppf(0.5 + 0.5 * CONFIDENCE, freedom) * np.sqrt(squares[0] + squares[1])
        return np.exp(ratio), np.exp(ratio - reach), np.exp(ratio + reach)
