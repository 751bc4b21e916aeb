"""The two records of the whole vehicle: `System`, which never changes during a run, and `State`, which does."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..rui.state import TreeState
from ..rui.sweeps.articulated import Cuts, new_cuts
from ..rui.sweeps.elastic import elastic_place
from ..rui.sweeps.kinematics import Motion, new_motion, update_motion
from ..rui.sweeps.response import Response, new_response
from ..rui.sweeps.tree import Tree, build_tree, new_rows, rest_lanes
from .body_tree import GRAVITY, build_body_table, sprung_bodies
from .coil import Coil, CoilState, build_coil, new_coil_state
from .drive.drive import Drive, DriveState, build_drive, new_drive_state
from .drive.schedule import Schedule, constant_schedule
from .hinge_springs import HingeSprings, build_hinge_springs
from .mount_energy import MountEnergyState, new_mount_energy_state
from .mount_law import FieldState, new_field_state
from .mount_loads import loads_at_rest
from .mounts import Mounts, build_mounts
from .supports import Supports, build_supports
from .suspension import Suspension, build_suspension
from .tracks.tracks import Tracks, TrackState, TrackWork, build_tracks, new_track_state, new_track_work


@dataclass(frozen=True)
class Operation:
    """How the vehicle is driven in a run.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Operation(speed=10.0, engine_speed=1650.0, imposed_displacement=False).track_phase
    0.0
    """

    speed: float  # m/s, without effect where there is a schedule
    engine_speed: float  # r/min, 0 for a standing engine; likewise, and with gears
    imposed_displacement: bool  # the paper's engine excitation instead of forces and moments
    track_phase: float = 0.0  # part of a pitch by which the right track lies ahead of the left one
    schedule: Schedule | None = None  # of speed, path and engine speed
    gears: bool = False  # whether the engine's speed follows the vehicle's

    @property
    def plan(self) -> Schedule:
        """The demanded speed and path of the run."""
        return self.schedule or constant_schedule(self.speed, self.engine_speed)


class System(NamedTuple):
    """Everything that does not change while a run steps."""

    dt: float  # s
    tree: Tree
    springs: HingeSprings
    suspension: Suspension
    mounts: Mounts
    coil: Coil
    drive: Drive
    supports: Supports
    tracks: Tracks


class State(NamedTuple):
    """Everything that does, changed in place."""

    tree: TreeState
    tracks: TrackState
    coils: CoilState
    fields: FieldState
    drive: DriveState
    flight: np.ndarray  # (1,) time since a shoe last touched the ground, s
    mount_energy: MountEnergyState


class Work(NamedTuple):
    """Room for the intermediate results of a step."""

    motion: Motion
    torques: np.ndarray  # (rows,) of the hinges, N m or N
    cuts: Cuts
    response: Response
    tracks: TrackWork


def build_system(vehicle, operation, dt):
    """Return the `System` of a vehicle (`parameters.Vehicle`) in an operation, for physics steps of dt [s].

    Raises
    ------
    tracks.layout.TrackDoesNotFit
        The links do not close round the running gear.
    ValueError
        The coils' delay is no whole number of steps, or gears are asked for that the vehicle does not have.
    """
    table = build_body_table(vehicle)
    tree = build_tree(table, gravity=(0.0, 0.0, -GRAVITY))
    rows = body_rows(vehicle, tree)
    mass = {body.name: body.mass for body in table}
    running_tracks = build_tracks(vehicle, rows)
    standing = build_supports(vehicle, rows, running_tracks.tensioner.fitted)
    pull = sum(weight - down.sum() for weight, down in zip(standing.upper_weight, standing.pull[:, :, 1], strict=True))
    load = sum(mass[name] for name in sprung_bodies(vehicle)) * GRAVITY + pull
    return System(
        dt=dt,
        tree=tree,
        springs=build_hinge_springs(vehicle, rows),
        suspension=build_suspension(vehicle, rows, load),
        mounts=build_mounts(vehicle, rows, loads_at_rest(vehicle)),
        coil=build_coil(vehicle, dt),
        drive=build_drive(vehicle, rows, operation.plan, operation.imposed_displacement, operation.gears),
        supports=standing,
        tracks=running_tracks,
    )


def body_rows(vehicle, tree):
    """Return the rows in the tree of all bodies of a vehicle, by name."""
    return {body.name: row for body, row in zip(build_body_table(vehicle), tree.row.tolist(), strict=True)}


def new_state(system):
    """Return a state with every coordinate at zero and no track laid."""
    return State(
        tree=_rest(system.tree),
        tracks=new_track_state(system.tracks),
        coils=new_coil_state(system.coil, system.mounts.coils),
        fields=new_field_state(len(system.mounts.body)),
        drive=new_drive_state(system.drive),
        flight=np.zeros(1),
        mount_energy=new_mount_energy_state(len(system.mounts.body)),
    )


def _rest(tree):
    """Return the state of a tree with every coordinate zero and the bodies behind elastic hinges in their places."""
    state, motion = rest_lanes(tree), new_motion(tree)
    for k in range(len(tree.elastic.child)):
        update_motion(tree, state, motion)
        state.position[1 + k] = elastic_place(tree, motion, k)
    return state


def new_work(system):
    """Return working room for a system."""
    tree = system.tree
    return Work(new_motion(tree), new_rows(tree), new_cuts(tree), new_response(tree), new_track_work(system.tracks))
