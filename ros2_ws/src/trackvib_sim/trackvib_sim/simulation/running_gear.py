"""What could be measured in the running gear: travel and forces of the suspension, of wheels, ground, tracks and drive.

It is found beside the simulation, from copies of its state at the end of a period, so that looking changes nothing.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.units import RPM
from ..rui.sweeps.articulated import CutOffset, new_cuts
from ..rui.sweeps.cells import columns, copy_cells
from ..rui.sweeps.kinematics import MotionOffset, body_axes, new_motion, update_motion
from ..vehicle.body_tree import SIDE_NAMES, SIDES, wheel_name
from ..vehicle.parameters import Vehicle
from ..vehicle.suspension import shock_force
from ..vehicle.tracks.nodes import STRIDE, NodeWorkOffset
from ..vehicle.tracks.tracks import add_tracks, new_track_work
from ..vehicle.tracks.wheels import END, LOWER_RUN, UPPER_RUN
from .simulation import Simulation

RUNS = ("lower", "front", "upper", "rear")


class MeasuredKind(NamedTuple):
    """One kind of running-gear signal.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.MeasuredKind("engine_speed", "r/min", "of the crankshaft", ("engine",)).unit
    'r/min'
    """

    name: str
    unit: str
    meaning: str
    names: tuple  # of what each number belongs to


class RunningGear:
    """Reads the running gear of a `simulation.Simulation`.

    Attributes
    ----------
    kinds : tuple of MeasuredKind
        The kinds that `read` returns, in its order.

    Examples
    --------
    The ground carries the vehicle: forces upwards on both tracks, after a tenth of a second on a level road.

    >>> import trackvib_sim as tv
    >>> vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    >>> settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    >>> simulation = tv.Simulation(vehicle, settings)
    >>> _ = tv.run_open_loop(simulation, tv.Iso8608Road("A", seed=1), periods=100)
    >>> gear = tv.RunningGear(vehicle, simulation)
    >>> force = dict(zip((kind.name for kind in gear.kinds), gear.read()))["ground_force"]
    >>> bool(abs(force[[2, 5]].sum() / (39_600 * 9.81) - 1.0) < 0.5)
    True
    """

    def __init__(self, vehicle: Vehicle, simulation: Simulation):
        self._simulation, tree = simulation, simulation.system.tree
        self._motion, self._cuts = new_motion(tree), new_cuts(tree)
        self._work = new_track_work(simulation.system.tracks, kept=2)
        stations = range(vehicle.swing_arms.stations)
        wheels = tuple(wheel_name(side, station) for side in SIDES for station in stations)
        sides = tuple(SIDE_NAMES.values())
        by_axis = tuple(f"{side}_{axis}" for side in sides for axis in "xyz")
        by_run = tuple(f"{side}_{run}" for side in sides for run in RUNS)
        self._wheels = simulation.system.tracks.wheels.row[:, : len(stations)].ravel()
        self.kinds = (
            MeasuredKind("suspension_travel", "m", "of the road wheel up in the hull, from static ride height", wheels),
            MeasuredKind("damper_force", "N", "of the shock absorber at the road wheel, against compression", wheels),
            MeasuredKind("wheel_force", "N", "of the track on the road wheel, upwards", wheels),
            MeasuredKind("ground_force", "N", "of the ground on the track, axes of odom", by_axis),
            MeasuredKind(
                "track_tension",
                "N",
                "mean of the run, weighted to the middle between wheels",
                by_run,
            ),
            MeasuredKind("sprocket_torque", "N m", "of the drive on the sprocket", sides),
            MeasuredKind("engine_speed", "r/min", "of the crankshaft", ("engine",)),
        )

    def read(self) -> list[np.ndarray]:
        """Return the numbers of each kind at the end of the last period; at least one period must have been done."""
        system, state = self._simulation.system, self._simulation.state
        suspension, tracks = system.suspension, copy_cells(state.tracks)
        update_motion(system.tree, state.tree, self._motion)
        self._cuts.cells[:] = 0.0
        # no time passes: the shear of the ground stays as it is
        road, path = self._simulation.road_at_hand, state.drive.path
        add_tracks(system.tracks, tracks, state.tree, road, path, self._motion, self._cuts, self._work, 0.0, False)
        rates = suspension.reach * state.tree.hinge_rate[suspension.row]
        force = [self._forces(side, tracks) for side in SIDES]
        return [
            suspension.reach * state.tree.hinge[suspension.row],
            np.array([shock_force(suspension, i, rate) for i, rate in enumerate(rates.tolist())]),
            columns(self._cuts, CutOffset.FORCE, 3)[self._wheels, 2],
            np.concatenate([ground for ground, _ in force]),
            np.concatenate([tension for _, tension in force]),
            state.drive.driving.torque.copy(),
            state.drive.crank.speed / RPM,
        ]

    def _forces(self, side, tracks):
        """Force (3,) of the ground on a side's track, and the mean tension of its runs (4,), by `RUNS`."""
        system = self._simulation.system.tracks
        n, end = system.chain.links[side], system.sprockets.end
        nodes = self._work.nodes[side].reshape(-1, STRIDE)
        place = 0.5 * (nodes[NodeWorkOffset.NEAR, 1 : n + 1] + nodes[NodeWorkOffset.NEAR, 2 : n + 2])
        # from the rearmost link on the ground forwards, round the front end and back
        ends = (tracks.outermost[side], tracks.link[side, -1])
        front, rear = ends if end > 0.0 else ends[::-1]
        last = len(self._wheels) // len(SIDES) - 1
        corners = (tracks.link[side, last], tracks.link[side, 0] + 1, front, rear, tracks.link[side, last])
        lower, upper = self._hubs(side, LOWER_RUN), self._hubs(side, UPPER_RUN)
        around = self._hubs(side, END) + [self._ahead(system.sprockets.row[side])]
        hubs = (lower, [max(lower), max(around)], around + upper, [min(lower), min(around)])
        tension = nodes[NodeWorkOffset.TENSION, 1 : n + 1]
        means = [_mean(tension, place, *corners[k : k + 2], sorted(hubs[k])) for k in range(len(RUNS))]
        return nodes[NodeWorkOffset.GROUND : NodeWorkOffset.GROUND + 3, 1 : n + 1].sum(1), np.array(means)

    def _hubs(self, side, run):
        """Places of the wheels of a side's run along the hull [m]."""
        wheels = self._simulation.system.tracks.wheels
        return [self._ahead(row) for row in wheels.row[side, wheels.run[side] == run]]

    def _ahead(self, row):
        hull = self._simulation.system.tracks.chain.hull
        origin = columns(self._motion, MotionOffset.ORIGIN, 3)
        return body_axes(self._motion, hull, tuple(origin[row] - origin[hull]))[0]


def _mean(tension, place, begin, end, hubs):
    """Mean tension of the links from number `begin` to before `end`, by their places along the hull [m].

    A link counts as 1 - cos(2 pi s), s being its place between the hubs of two neighbouring wheels: what passes on a
    wheel counts little, and no link comes or goes with a jump. A mean over the links that just touch no wheel would
    depend on when they touch one.
    """
    n = len(tension)
    links = (begin - 1 + np.arange((end - begin) % n)) % n
    weight = 1.0 - np.cos(2.0 * np.pi * np.interp(place[links], hubs, np.arange(len(hubs))))
    return (weight * tension[links]).sum() / weight.sum()
