"""The parameters of a mount's law from measured loops, by least squares.

Of each current stiffness and damping, for the law that yields the yield force and the rubber's stiffness, and of all
together a constant force. What the field carries is led along the measured displacement from zero, as in `mount_law`.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from ..numerics.compiled import kernel
from ..vehicle.mount_law import lead_field

CONFIDENCE = 0.95
_SLACK = 1e-3  # of the loop's largest force: parameters that do less are taken to do that


class Value(NamedTuple):
    """A parameter with half of its interval of confidence."""

    value: float
    half: float


class Fit(NamedTuple):
    """What a law makes of loops; the intervals hold if the residuals are independent of each other."""

    law: str  # one of LAWS
    offset: Value  # N
    stiffness: dict  # current [A] -> Value [N/m], of rubber and field together; where it yields the rubber's at 0 A
    damping: dict  # current -> Value [N s/m]
    yield_force: dict  # current -> Value [N]; empty for the law without
    force: list  # of each loop the fitted force (n,) N
    residual: float  # RMS of what is left over the RMS of the measured forces about the offset


def fit_loops(loops, law):
    """Return the `Fit` of a law to `measured.MeasuredLoop`s.

    Raises
    ------
    ValueError
        No loop has a field (current above 0) though the law yields.
    """
    currents = sorted({loop.current for loop in loops})
    fields = [current for current in currents if current > 0.0] if law == "yielding" else []
    if law == "yielding" and not fields:
        raise ValueError("no loop has a current above 0 A, so there is no field that could yield")
    problem = _Problem(loops, currents, fields)
    found = least_squares(problem.residuals, problem.start(), bounds=(problem.lowest(), np.inf), x_scale="jac")
    free = max(problem.rows - len(found.x), 1)
    scatter = np.linalg.pinv(found.jac.T @ found.jac) * (2.0 * found.cost / free)
    half = student.ppf(0.5 + 0.5 * CONFIDENCE, free) * np.sqrt(np.diag(scatter)) * problem.scale
    values = [Value(float(a), float(b)) for a, b in zip(found.x * problem.scale, half, strict=True)]
    offset, stiffness, damping, limit = problem.named(values)
    if fields:
        rubber = stiffness[0.0]
        stiffness |= {i: Value(rubber.value + k.value, float(np.hypot(rubber.half, k.half)))
                      for i, k in stiffness.items() if i > 0.0}  # fmt: skip
    force = problem.forces(found.x)
    left = np.concatenate([loop.force - each for loop, each in zip(loops, force, strict=True)])
    about = np.concatenate([loop.force - offset.value for loop in loops])
    residual = float(np.sqrt((left**2).mean() / (about**2).mean()))
    return Fit(law, offset, stiffness, damping, limit, force, residual)


class _Problem:
    """Unknowns in one row: the offset, stiffnesses, dampings and yield forces; all scaled.

    Where a field yields, the stiffness at 0 A is the rubber's, and those of the fields come on top of it.
    """

    def __init__(self, loops, currents, fields):
        self._loops, self._currents, self._fields = loops, currents, fields
        self._springs = [0.0, *fields] if fields else currents
        self.rows = sum(len(loop.force) for loop in loops)
        force = max(np.ptp(loop.force) for loop in loops) / 2.0
        way, speed = (max(np.abs(getattr(loop, name)).max() for loop in loops) for name in ("displacement", "velocity"))
        counts = 1, len(self._springs), len(currents), len(fields)
        self.scale = np.repeat([force, force / way, force / speed, force], counts)
        self._ends = np.cumsum(counts)[:-1]

    def start(self):
        """No offset, and of the rest what gives half of the largest force."""
        x = np.full(len(self.scale), 0.5)
        x[0] = 0.0
        return x

    def lowest(self):
        """The least values; the constant force may be negative."""
        x = np.full(len(self.scale), _SLACK)
        x[0] = -np.inf
        return x

    def named(self, row):
        """Split a row: the offset, and by current stiffness, damping and yield force."""
        first, *others = (row[a:b] for a, b in pairwise((0, *self._ends, len(row))))
        names = self._springs, self._currents, self._fields
        return first[0], *(dict(zip(a, b, strict=True)) for a, b in zip(names, others, strict=True))

    def forces(self, x):
        """Return the force (n,) of each loop."""
        offset, stiffness, damping, limit = self.named((x * self.scale).tolist())
        found = []
        for loop in self._loops:
            field = np.zeros(len(loop.force))
            if loop.current in limit:
                _lead(stiffness[loop.current], limit[loop.current], loop.displacement, field)
            spring = stiffness[0.0 if self._fields else loop.current] * loop.displacement
            found.append(offset + spring + field + damping[loop.current] * loop.velocity)
        return found

    def residuals(self, x):
        """Return what is left of all forces over the largest (rows,)."""
        found = self.forces(x)
        return np.concatenate(
            [(loop.force - force) / self.scale[0] for loop, force in zip(self._loops, found, strict=True)]
        )


@kernel
def _lead(stiffness, limit, displacement, force):
    """Lead a field along a way from where it is at ease; twice, so that it has forgotten where it began."""
    here, carried = 0.0, 0.0
    for _ in range(2):
        for i in range(len(displacement)):
            carried = lead_field(stiffness, limit, carried, displacement[i] - here)
            here = displacement[i]
            force[i] = carried
