"""One evaluation of the vehicle's body tree (46 degrees of freedom), ours beside other engines in the same run.

    ./trackvib exec -- python bench/body_tree.py

An evaluation is: from coordinates, speeds and hinge torques to all accelerations. Ours and MuJoCo's run in a compiled
loop. Pinocchio and Drake are called from Python; what such a call costs is measured on a single free body and taken
off, which favours them by the work on that body. Before anything is timed all have to agree in 100 random states.
"""

import importlib.util
import sys

import numpy as np
from machine import best_times, machine
from peers import DrakeTree, MujocoTree, PinocchioTree
from rich.console import Console
from rich.progress import track
from rich.table import Table
from trackvib_sim.data import find_vehicle
from trackvib_sim.numerics.compiled import kernel
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import no_loads, rest_state
from trackvib_sim.rui.sweeps.articulated import new_cuts, open_cuts
from trackvib_sim.rui.sweeps.kinematics import new_motion, update_motion
from trackvib_sim.rui.sweeps.response import new_response
from trackvib_sim.rui.sweeps.riccati import solve_accelerations
from trackvib_sim.rui.sweeps.tree import build_tree, new_rows, to_lanes
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.vehicle_file import read_vehicle

GRAVITY = (0.0, 0.0, -9.81)
STATES, AGREE = 100, 1e-9
CALLS, ROUNDS = 2000, 30
PEERS = {"pinocchio": PinocchioTree, "mujoco": MujocoTree, "pydrake": DrakeTree}


class OurTree:
    """The Riccati form, with the methods of the peers."""

    name = "trackvib"

    def __init__(self, bodies, gravity):
        self._bodies, self._gravity = bodies, gravity
        self._tree = build_tree(bodies, gravity)
        self._records = new_motion(self._tree), new_cuts(self._tree), new_response(self._tree)

    def accelerations(self, state, torque):
        """As of the peers."""
        self._state = to_lanes(self._tree, state)
        self._torques = new_rows(self._tree)
        self._torques[self._tree.row] = torque
        found = accelerations(self._bodies, state, no_loads(self._bodies)._replace(torque=torque), self._gravity)
        return np.concatenate((found.linear[0], found.angular[0], found.hinge[1:]))

    def calls(self, count):
        """As of the peers."""
        arguments = self._tree, self._state, self._torques, *self._records
        _evaluate(*arguments, 1)
        return {"Riccati": lambda: _evaluate(*arguments, count)}


@kernel
def _evaluate(tree, state, torques, motion, cuts, response, count):
    for _ in range(count):
        update_motion(tree, state, motion)
        open_cuts(tree, motion, torques, cuts)
        solve_accelerations(tree, motion, cuts, response)


def random_state(bodies, random):
    """Return a state and hinge torques in which everything turns, moves and is loaded."""
    state = rest_state(bodies)
    attitude = random.normal(size=4)
    state.attitude[0] = attitude / np.linalg.norm(attitude)
    for part in (state.position, state.velocity, state.angular_velocity, state.hinge_rate):
        part[...] = random.normal(size=part.shape)
    state.hinge[:] = 0.5 * random.normal(size=len(bodies))
    return state, 1e3 * random.normal(size=len(bodies))


def main():
    """Check, time, print; exit code 1 if the engines do not agree."""
    out = Console()
    bodies = build_body_table(read_vehicle(find_vehicle())[0])
    installed = {name: peer for name, peer in PEERS.items() if importlib.util.find_spec(name)}
    for name in PEERS.keys() - installed.keys():
        package = name.removeprefix("py")
        out.print(f"{PEERS[name].name} is not installed: ./trackvib exec -- python -m pip install {package}")
    engines = [kind(bodies, GRAVITY) for kind in (OurTree, *installed.values())]
    random = np.random.default_rng(1)
    worst = dict.fromkeys((engine.name for engine in engines), 0.0)
    for _ in track(range(STATES), "comparing", console=out, transient=True):
        state, torque = random_state(bodies, random)
        ours, *theirs = (engine.accelerations(state, torque) for engine in engines)
        for engine, found in zip(engines[1:], theirs, strict=True):
            worst[engine.name] = max(worst[engine.name], np.abs(found - ours).max() / np.abs(ours).max())
    alone = [engine for kind in installed.values() for engine in (kind(bodies[:1], GRAVITY),)]
    for engine in alone:
        engine.accelerations(rest_state(bodies[:1]), np.zeros(1))
    tasks = {(engine.name, how): task for engine in engines for how, task in engine.calls(CALLS).items()}
    calls = {(engine.name, how, "call"): task for engine in alone for how, task in engine.calls(CALLS).items()}
    times = best_times({**tasks, **calls}, ROUNDS)
    micro = {key: 1e6 * time / CALLS for key, time in times.items()}
    net = {key: micro[key] - (micro[(*key, "call")] if key[0] in ("Pinocchio", "Drake") else 0.0) for key in tasks}
    ours = net["trackvib", "Riccati"]

    table = Table(title=f"{len(bodies)} bodies, {len(bodies) + 5} degrees of freedom, one core of {machine()}")
    for column in ("engine", "how", "as timed, us", "less the call, us", "/ ours", "largest difference"):
        table.add_column(column, justify="left" if column in ("engine", "how") else "right")
    for key in tasks:
        difference = "" if key[0] == "trackvib" else f"{worst[key[0]]:.0e}"
        table.add_row(*key, f"{micro[key]:.2f}", f"{net[key]:.2f}", f"{net[key] / ours:.1f}", difference)
    out.print(table)
    if max(worst.values()) > AGREE:
        sys.exit(f"error: engines differ by {max(worst.values()):.1e} of the largest acceleration, accepted {AGREE}")
    print(f"fastest peer / ours = {min(net[key] for key in tasks if key[0] != 'trackvib') / ours:.1f}")


if __name__ == "__main__":
    main()
