"""Time, memory and accuracy of one evaluation from 10 to 1 000 000 degrees of freedom, chains and branched trees.

"branched" has three bodies on each body, "brush" chains of six links on one body.

    ./trackvib exec -- python bench/scaling.py [PICTURE.png]

MuJoCo runs beside it up to 300 degrees of freedom. The accuracy is that of a
manufactured solution on chains: torques by inverse dynamics for given random accelerations, from which the sweeps have
to find those accelerations again, at the very end of the chain.
"""

import sys
from pathlib import Path

import numpy as np
from inverse_dynamics import required_torques
from machine import best_times, machine
from matplotlib.figure import Figure
from peers import MujocoTree
from rich.console import Console
from rich.progress import track
from rich.table import Table
from trackvib_sim.numerics.compiled import kernel
from trackvib_sim.rui.state import rest_state
from trackvib_sim.rui.sweeps.articulated import apply_wrench, new_cuts, open_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import new_motion, update_motion
from trackvib_sim.rui.sweeps.response import ResponseOffset, new_response
from trackvib_sim.rui.sweeps.riccati import solve_accelerations
from trackvib_sim.rui.sweeps.tree import build_tree, new_rows, to_lanes
from trackvib_sim.rui.table import Body, Hinge

GRAVITY = (0.0, 0.0, -9.81)
SIZES = [10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000]
PEER_LIMIT = 300  # dof; larger chains are more than its compiler takes
INERTIA = np.diag([0.02, 0.05, 0.06])
AXES = ((0, 1, 0), (0, 0, 1), (1, 0, 0))
TOPOLOGIES = {
    "chain": lambda row: row - 1,
    "branched": lambda row: (row - 1) // 3,
    "brush": lambda row: 0 if (row - 1) % 6 == 0 else row - 1,
}


def table_of(parent_of, dof):
    """Return a table with `dof` degrees of freedom: a free root and links by revolute hinges."""
    bodies = [Body(0, "0", 1.0, (0.1, 0.0, 0.02), INERTIA)]
    for row in range(1, max(dof - 5, 2)):
        hinge = Hinge(row, "revolute", str(parent_of(row)), (0.2, 0.01, 0.0), AXES[row % 3])
        bodies.append(Body(row, str(row), 1.0, (0.1, 0.0, 0.02), INERTIA, hinge))
    return bodies


def state_of(bodies, random):
    """Return a state: everything bent and in motion, slowly enough for a long chain's end."""
    state = rest_state(bodies)
    state.hinge[1:] = 0.5 * random.normal(size=len(bodies) - 1)
    state.hinge_rate[1:] = 0.01 * random.normal(size=len(bodies) - 1)
    return state


@kernel
def evaluate(tree, state, torques, force, moment, motion, cuts, response, count):
    """Evaluate `count` times, with a wrench on the root."""
    for _ in range(count):
        update_motion(tree, state, motion)
        open_cuts(tree, motion, torques, cuts)
        apply_wrench(cuts, 0, force, moment)
        solve_accelerations(tree, motion, cuts, response)


def measure(parent_of, dof, accuracy, with_peer, random):
    """Return seconds per evaluation, bytes of all records, seconds of the peer and error (None where not measured)."""
    bodies = table_of(parent_of, dof)
    tree, plain = build_tree(bodies, GRAVITY), state_of(bodies, random)
    state, torques = to_lanes(tree, plain), new_rows(tree)
    motion, cuts, response = new_motion(tree), new_cuts(tree), new_response(tree)
    still = (0.0, 0.0, 0.0)
    arguments = tree, state, torques, still, still, motion, cuts, response
    evaluate(*arguments, 1)
    count = max(1, 200_000 // dof)
    tasks = {"ours": lambda: evaluate(*arguments, count)}
    if with_peer:
        peer = MujocoTree(bodies, GRAVITY)
        peer.accelerations(plain, np.zeros(len(bodies)))
        tasks |= peer.calls(count)
    times = {name: time / count for name, time in best_times(tasks, 5 if dof > 50_000 else 20).items()}
    size = sum(part.nbytes for record in (tree, state, motion, cuts, response) for part in _arrays(record))
    error = None
    if accuracy:
        wanted = random.normal(size=len(bodies))
        rate = plain.hinge_rate
        torques[:], force, moment = required_torques(bodies, motion, rate, wanted, GRAVITY)
        torques[0] = 0.0
        evaluate(tree, state, torques, tuple(force), tuple(moment), motion, cuts, response, 1)
        found = columns(response, ResponseOffset.HINGE, 1)[:, 0]
        error = abs(found[-1] - wanted[-1]) / np.abs(wanted).max()
    return times.pop("ours"), size, min(times.values(), default=None), error


def _arrays(record):
    for part in record:
        if isinstance(part, np.ndarray):
            yield part
        elif isinstance(part, tuple):
            yield from _arrays(part)


def draw(results, path):
    """Draw time and memory against degrees of freedom."""
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, rows in results.items():
        dof = [row[0] for row in rows]
        left.loglog(dof, [row[1] for row in rows], "o-", label=name)
        right.loglog(dof, [row[2] for row in rows], "o-", label=name)
        peer = [(row[0], row[3]) for row in rows if row[3]]
        if peer and name == "chain":
            left.loglog(*zip(*peer, strict=True), "k--", marker="x", label="MuJoCo, chain")
    ends = np.array([SIZES[0], SIZES[-1]])
    left.loglog(ends, 1e-8 * ends, color="0.7", label="10 ns a degree of freedom")
    left.set(xlabel="degrees of freedom", ylabel="one evaluation, s", title="time")
    right.set(xlabel="degrees of freedom", ylabel="all records, bytes", title="memory")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main():
    """Measure, print, draw."""
    picture = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs" / "scaling.png"
    out, random = Console(), np.random.default_rng(1)
    table = Table(title=f"one evaluation, one core of {machine()}")
    for column in ("tree", "dof", "us", "ns/dof", "MB", "B/dof", "MuJoCo / ours", "error"):
        table.add_column(column, justify="left" if column == "tree" else "right")
    results = {name: [] for name in TOPOLOGIES}
    cases = [(name, dof) for name in TOPOLOGIES for dof in SIZES]
    for name, dof in track(cases, "measuring", console=out, transient=True):
        with_peer = dof <= PEER_LIMIT
        time, size, peer, error = measure(TOPOLOGIES[name], dof, name == "chain", with_peer, random)
        results[name].append((dof, time, size, peer))
        table.add_row(
            name, f"{dof}", f"{1e6 * time:.4g}", f"{1e9 * time / dof:.1f}", f"{size / 1e6:.3f}", f"{size / dof:.0f}",
            f"{peer / time:.1f}" if peer else "", "" if error is None else f"{error:.0e}",
        )  # fmt: skip
    out.print(table)
    draw(results, picture)
    out.print(f"picture: {picture}")


if __name__ == "__main__":
    main()
