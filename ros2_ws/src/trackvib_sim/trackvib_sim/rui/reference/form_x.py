"""Overall transfer equation in the paper's size (Form X): six unknowns a free end, and nothing else.

The paper's equation [Tao2025] has the accelerations of the free ends as its only unknowns, so each hinge acceleration
must have been eliminated on the way. Here that is done by exchange: on arriving at a hinge, the known moment (force)
along its axis, E z_I = 0, is solved for that unknown behind the hinge which has the largest coefficient, and the hinge
acceleration takes over its column. The number of unknowns stays the same, and the largest coefficient is never zero
because all bodies have inertia (derived in docs/method.md). Eliminating with the *next* hinge's axis instead, which
also keeps the size, fails where consecutive axes are perpendicular.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..state import Accelerations, Loads, TreeState
from ..table import Body
from .elements import ONE
from .form_a import OverallTransfer, overall_transfer, solve_equilibrated


class Replacement(NamedTuple):
    """What one hinge did: the unknown of `column` was `rule` @ [unknowns; 1], and its column went to the hinge."""

    hinge: int  # number
    column: int
    rule: np.ndarray  # (columns + 1,), zero at `column`


@dataclass(frozen=True)
class FormXTransfer:
    """The square system matrix @ x = right with the names of its rows and columns.

    `equations` holds slices by ("main", body): force and moment rows m, q of a tree's root, and ("geometry", hinge).
    `tips` holds slices by the tip's body number; a column in it is the acceleration component of the tip's free end,
    or what `holders` says: the number of the last hinge that took the column over (0 for none).
    """

    transfer: OverallTransfer
    matrix: np.ndarray
    right: np.ndarray
    equations: dict
    tips: dict
    exchanges: list

    @property
    def holders(self):
        """Hinge number that holds each column after all exchanges, 0 where a free end still does."""
        holders = np.zeros(len(self.right), dtype=int)
        for exchange in self.exchanges:
            holders[exchange.column] = exchange.hinge
        return holders

    def solve(self):
        """Return z_all in the columns of `transfer`: exchanges are undone last to first."""
        x = np.append(solve_equilibrated(self.matrix, self.right), 1.0)
        z_all = self.transfer.known()
        for exchange in reversed(self.exchanges):
            z_all[self.transfer.unknowns["hinge", exchange.hinge]] = x[exchange.column]
            x[exchange.column] = exchange.rule @ x
        for number, place in self.tips.items():
            start = self.transfer.unknowns["tip", number].start
            z_all[start : start + 6] = x[place]
        return self.transfer.with_root(z_all)


def form_x_transfer(transfer):
    """Return the `ExchangedTransfer` of an `OverallTransfer`.

    State vectors are expressed as (13, columns + 1) maps of the six unknowns of every tip and a one.
    """
    numbers = [transfer.bodies[row].number for row in transfer.tips]
    tips = {number: slice(6 * k, 6 * k + 6) for k, number in enumerate(numbers)}
    size = 6 * len(tips)
    passed, blocks, exchanges = {}, {}, []
    for row in reversed(range(len(transfer.bodies))):
        body, hinge = transfer.bodies[row], transfer.hinge[row]
        inputs = [passed[child] for child in transfer.inputs[row]] or [_free_end(tips[body.number], size)]
        for H, child, z in zip(transfer.geometry[row], transfer.inputs[row][1:], inputs[1:], strict=True):
            blocks["geometry", transfer.bodies[child].hinge.number] = H @ inputs[0] - z[:6]
        output = sum(U @ z for U, z in zip(transfer.body[row], inputs, strict=True))
        if hinge is None:
            blocks["main", body.number] = output[6:12]
        elif hinge.E is None:
            passed[row] = hinge.U @ output
        else:
            exchange = _exchange(body.hinge.number, hinge.E @ output)
            exchanges.append(exchange)
            # the geometric equations behind the hinge know the replaced unknown as well
            blocks = {name: _replace(block, exchange) for name, block in blocks.items()}
            passed[row] = hinge.U @ _replace(output, exchange)
            passed[row][:, exchange.column] += hinge.b
    equations = {name: slice(6 * k, 6 * k + 6) for k, name in enumerate(blocks)}
    system = np.vstack(list(blocks.values()))
    return FormXTransfer(transfer, system[:, :-1], -system[:, -1], equations, tips, exchanges)


def form_x(
    bodies: Sequence[Body], state: TreeState, loads: Loads, gravity: Sequence[float] = (0.0, 0.0, -9.81)
) -> Accelerations:
    """Return the `Accelerations` of a table by Form X; parameters as of `form_a.overall_transfer`.

    Examples
    --------
    A torque of 5 N m turns an arm that hangs in free fall.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> loads = rui.no_loads(bodies)
    >>> loads.torque[1] = 5.0
    >>> found = rui.form_x(bodies, rui.rest_state(bodies), loads)
    >>> round(float(found.hinge[1]), 6)  # rad/s^2
    23.75
    """
    transfer = overall_transfer(bodies, state, loads, gravity)
    return transfer.accelerations(form_x_transfer(transfer).solve())


def _free_end(place, size):
    z = np.zeros((13, size + 1))
    z[:6, place] = np.eye(6)
    z[ONE, -1] = 1.0
    return z


def _exchange(hinge, row):
    """Solve row @ [unknowns; 1] = 0 for the unknown with the largest coefficient."""
    column = int(np.argmax(np.abs(row[:-1])))
    rule = -row / row[column]
    rule[column] = 0.0
    return Replacement(hinge, column, rule)


def _replace(rows, exchange):
    """Put the rule in the place of the exchanged unknown; its column is free for the hinge afterwards."""
    replaced = rows + np.outer(rows[:, exchange.column], exchange.rule)
    replaced[:, exchange.column] = 0.0
    return replaced
