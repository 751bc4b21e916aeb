"""Both tracks with all that they touch: the records, one evaluation of their forces, one step."""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...rui.sweeps.kinematics import MotionOffset, motion_vector
from ..body_tree import SIDES
from ..drive.path import path_distance
from .ground import Ground, build_ground, road_height
from .layout import fit_idler, idler_load
from .nodes import Chain, build_chain, new_node_work, new_nodes
from .one_track import TrackPart, add_track, move_track
from .rims import Contacts, WheelLoadOffset, new_contacts
from .sprockets import Sprockets, build_sprockets
from .tensioner import Tensioner, TensionerState, build_tensioner
from .wheels import LOWER_RUN, Wheels, build_wheels

TRACK_PARTS = len(TrackPart)
MESHED = 0.75  # teeth by which the outermost pin may be away from its gap; from half a tooth on it is over the next one


class Tracks(NamedTuple):
    """Everything about both tracks that does not change during a run."""

    chain: Chain
    ground: Ground
    wheels: Wheels
    sprockets: Sprockets
    tensioner: Tensioner


class TrackState(NamedTuple):
    """Everything that does, left first."""

    nodes: np.ndarray  # (2, NODE_STATE STRIDE)
    link: np.ndarray  # (2, c) that each wheel touches; of an idler the outermost node
    outermost: np.ndarray  # (2,) node on the sprocket
    passed: np.ndarray  # (2,) pins that became the outermost, from where nothing is `away`
    tensioner: TensionerState


class TrackWork(NamedTuple):
    """Room for the intermediate results of a step."""

    nodes: np.ndarray  # (2, NODE_WORK STRIDE), or one row for each track in its turn
    contacts: Contacts  # of the wheels of one side
    load: np.ndarray  # (LOAD,) of one wheel
    push: np.ndarray  # (2,) of the track on the idler along the hull's x axis, N
    dissipation: np.ndarray  # (TRACK_PARTS,) W
    stored: np.ndarray  # (TRACK_PARTS,) J
    touching: np.ndarray  # (1,) shoes on the ground
    away: np.ndarray  # (2,) teeth between the outermost pin and the gap that it belongs to


def build_tracks(vehicle, rows):
    """Return the record for the vehicle.

    Raises
    ------
    layout.TrackDoesNotFit
        The links do not close round the running gear.
    """
    travel = np.array([fit_idler(vehicle, side) for side in SIDES])
    load = np.array([idler_load(vehicle, side, travel[side]) for side in SIDES])
    return Tracks(
        build_chain(vehicle, rows),
        build_ground(vehicle),
        build_wheels(vehicle, rows),
        build_sprockets(vehicle, rows),
        build_tensioner(vehicle, travel, load),
    )


def new_track_state(tracks):
    """Return the state of tracks that are not laid yet."""
    slides = TensionerState(np.zeros(2), np.zeros(2))
    return TrackState(new_nodes(), np.ones(tracks.wheels.row.shape, int), np.ones(2, int), np.zeros(2), slides)


def new_track_work(tracks, kept=1):
    """Return working room in which the nodes' results of both tracks are `kept` (2), or those of the last one (1)."""
    return TrackWork(
        nodes=new_node_work(kept),
        contacts=new_contacts(tracks.wheels.row.shape[1]),
        load=np.zeros(WheelLoadOffset.SIZE),
        push=np.zeros(2),
        dissipation=np.zeros(TRACK_PARTS),
        stored=np.zeros(TRACK_PARTS),
        touching=np.zeros(1),
        away=np.zeros(2),
    )


@inlined
def add_tracks(tracks, state, tree_state, road, path, motion, cuts, work, dt, audit):
    """Add the forces of both tracks to the bodies of the tree, and prepare those on their own nodes.

    The shear of the ground under the shoes is advanced by dt, and with `audit` heat and stored energy are booked.
    """
    _clear(work)
    for side in range(2):
        add_track(tracks, state, side, tree_state, road, path, motion, cuts, work, dt, audit)


@inlined
def advance_tracks(tracks, state, tree_state, road, path, motion, gravity, cuts, work, dt):
    """Add the forces of both tracks to the bodies of the tree, and advance their nodes and tensioners by dt.

    Bodies act on nodes by place and speed only, so nodes need not wait for the bodies' accelerations. Moved at once,
    the second track finds the room of the first one in the cache.
    """
    _clear(work)
    for side in range(2):
        add_track(tracks, state, side, tree_state, road, path, motion, cuts, work, dt, False)
        move_track(tracks, state, side, motion, gravity, work, dt)


@inlined
def _clear(work):
    work.dissipation[:] = 0.0
    work.stored[:] = 0.0
    work.touching[0] = 0.0


@inlined
def wheel_below_road(tracks, road, path, motion):
    """Return whether the hub of any road wheel lies below the road, where its links know no way out."""
    for side in range(2):
        for k in range(tracks.wheels.row.shape[1]):
            if tracks.wheels.run[side, k] == LOWER_RUN:
                hub = motion_vector(motion, MotionOffset.ORIGIN, tracks.wheels.row[side, k])
                if hub[2] < road_height(road, side, path_distance(path, hub[0], hub[1], path.distance[0])):
                    return True
    return False


@inlined
def track_skips(work):
    """Return whether a pin has left its gap for another."""
    return abs(work.away[0]) > MESHED or abs(work.away[1]) > MESHED
