"""Takes the energy account of a vehicle while it is stepped.

Symplectic Euler is the leapfrog method: places belong to the ends of the steps, speeds to their middle. So the
account of a step is that of its beginning, with its places and the mean of the speeds before (v) and after (v'): a
force of those places does the work F (v + v') dt / 2. Springs then close to rounding. A damper has the force of v and
takes the power

    c v (v + v') / 2 = c ((v + v') / 2)^2 + (c v^2 - c v'^2) / 4,

in terms of what it would take at the mean speeds, at those before and at those after. The last two make up for shocks,
whose first and last speeds differ: left out, they are 1 % of the drive's work.
"""

import numpy as np

from .energy import evaluations, new_account
from .system import new_state, new_work
from .tracks.nodes import STRIDE, NodeOffset


class EnergyMeter:
    """Takes the account of a vehicle step by step; the coils' currents should be constant.

    Attributes
    ----------
    account : Account
        Of the beginning of the last step.
    """

    def __init__(self, system):
        self.account = new_account()
        self._system, self._work = system, new_work(system)
        self._before, self._state = new_state(system), new_state(system)
        self._kept = list(zip(_arrays(self._before), _arrays(self._state), strict=True))
        self._evaluations = self._road = None

    def open(self, state):
        """Note the `system.State` before a step."""
        for source, (target, _) in zip(_arrays(state), self._kept, strict=True):
            target[:] = source

    def close(self, state, road):
        """Fill the account, given the state after the step on a `road.store.Road`."""
        if road is not self._road:
            self._evaluations = evaluations(self._system, self._state, road, self._work, self.account)
            self._road = road
        dissipation = []
        for share in (0.0, 1.0, 0.5):  # of the speeds after the step; those of the account come last
            for source, target in self._kept:
                target[:] = source
            for speed, after in zip(_speeds(self._state), _speeds(state), strict=True):
                speed += share * (after - speed)
            next(self._evaluations)
            dissipation.append(self.account.dissipation.copy())
        self.account.dissipation[:] += 0.25 * (dissipation[0] - dissipation[1])


def _arrays(record):
    """Return all arrays of a record of arrays and records, in its order."""
    return [array for part in record for array in ([part] if isinstance(part, np.ndarray) else _arrays(part))]


def _speeds(state):
    tree, tracks = state.tree, state.tracks
    nodes = tracks.nodes[:, NodeOffset.VELOCITY * STRIDE : NodeOffset.SHEAR * STRIDE]
    return tree.velocity, tree.angular_velocity, tree.hinge_rate, nodes, tracks.tensioner.rate
