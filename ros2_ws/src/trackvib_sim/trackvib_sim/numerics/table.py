"""Tables of numbers, looked up between their points."""

from .compiled import kernel


@kernel
def interpolate(at, values, x):
    """Return what a table (m,) of values at growing places gives at x: linear between, and beyond the ends as there."""
    low, high = 0, at.size - 1
    if x <= at[low]:
        return values[low]
    if x >= at[high]:
        return values[high]
    while high - low > 1:
        middle = (low + high) // 2
        if at[middle] <= x:
            low = middle
        else:
            high = middle
    part = (x - at[low]) / (at[high] - at[low])
    return (1.0 - part) * values[low] + part * values[high]
