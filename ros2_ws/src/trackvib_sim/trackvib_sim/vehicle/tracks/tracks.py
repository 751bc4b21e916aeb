"""Both tracks with all that they touch: the records, one evaluation of their forces, one step."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import kernel
from ...numerics.spatial import rotate
from ...rui.sweeps.articulated import apply_wrench
from ...rui.sweeps.kinematics import MotionOffset, motion_vector, rotation
from ..body_tree import SIDES
from ..drive.path import path_distance
from .ground import Ground, add_ground, build_ground, find_on_path, road_height
from .layout import fit_idler, idler_load
from .nodes import STRIDE, Chain, add_links, build_chain, move_nodes, new_node_work, new_nodes, see_from_hull
from .sprockets import Sprockets, add_sprocket, build_sprockets
from .tensioner import Tensioner, TensionerState, build_tensioner, move_tensioner, tensioner_energy
from .wheels import (
    END,
    LOWER_RUN,
    WheelLoadOffset,
    Wheels,
    add_wheel,
    build_wheels,
    find_link,
    find_outermost,
    hub_of,
    push_body,
)


class TrackPart(IntEnum):
    """Where energy is stored and dissipated in the tracks."""

    LINKS = 0
    GROUND = 1
    RIMS = 2
    TEETH = 3
    TENSIONERS = 4


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

    nodes: np.ndarray  # (2, NODE_WORK STRIDE)
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


def new_track_work():
    """Return working room."""
    return TrackWork(
        nodes=new_node_work(),
        load=np.zeros(WheelLoadOffset.SIZE),
        push=np.zeros(2),
        dissipation=np.zeros(TRACK_PARTS),
        stored=np.zeros(TRACK_PARTS),
        touching=np.zeros(1),
        away=np.zeros(2),
    )


@kernel
def add_tracks(tracks, state, tree_state, road, path, motion, cuts, work, dt):
    """Add the forces of both tracks to the bodies of the tree, and prepare those on their own nodes.

    The shear of the ground under the shoes is advanced by dt.
    """
    work.dissipation[:] = 0.0
    work.stored[:] = 0.0
    work.touching[0] = 0.0
    for side in range(2):
        nodes = work.nodes[side]
        see_from_hull(tracks.chain, tracks.chain.links[side], state.nodes[side], motion, nodes)
        dissipation, stored = add_links(tracks.chain, side, nodes)
        work.dissipation[TrackPart.LINKS] += dissipation
        work.stored[TrackPart.LINKS] += stored
        _add_wheels(tracks, state, side, motion, cuts, work)
        _add_sprocket(tracks, state, side, tree_state, motion, cuts, work)
        _add_ground(tracks, state, side, road, path, work, dt)


@kernel
def _add_wheels(tracks, state, side, motion, cuts, work):
    wheels, hull, n, load = tracks.wheels, tracks.chain.hull, tracks.chain.links[side], work.load
    for k in range(wheels.row.shape[1]):
        row, run = wheels.row[side, k], wheels.run[side, k]
        travel, rate, link = 0.0, 0.0, state.link[side, k]
        if run == END:
            travel, rate = state.tensioner.travel[side], state.tensioner.rate[side]
        hub = hub_of(motion, hull, row, travel, rate)
        if run == END:
            link = find_outermost(wheels.end, work.nodes[side], link, n)
        else:
            link = find_link(run, hub.x, work.nodes[side], link, n)
        state.link[side, k] = link
        load[:] = 0.0
        add_wheel(wheels, side, k, hub, link, n, work.nodes[side], load)
        push_body(cuts, motion, hull, row, load)
        work.dissipation[TrackPart.RIMS] += load[WheelLoadOffset.DISSIPATION]
        work.stored[TrackPart.RIMS] += load[WheelLoadOffset.STORED]
        if run == END:
            work.push[side] = load[WheelLoadOffset.FORCE]
            dissipation, stored = tensioner_energy(tracks.tensioner, state.tensioner, side)
            work.dissipation[TrackPart.TENSIONERS] += dissipation
            work.stored[TrackPart.TENSIONERS] += stored
            # the rim's force acts at the shifted hub; the slide carries its moment about the idler's own place
            moment = (0.0, -travel * load[WheelLoadOffset.FORCE + 2], travel * load[WheelLoadOffset.FORCE + 1])
            apply_wrench(cuts, hull, (0.0, 0.0, 0.0), rotate(rotation(motion, hull), moment))


@kernel
def _add_sprocket(tracks, state, side, tree_state, motion, cuts, work):
    hull, n, load, row = tracks.chain.hull, tracks.chain.links[side], work.load, tracks.sprockets.row[side]
    end, before = tracks.sprockets.end, state.outermost[side]
    outermost = find_outermost(end, work.nodes[side], before, n)
    state.outermost[side] = outermost
    # steps of a few pins at most, where the numbers begin anew as well
    state.passed[side] += (outermost - before + n + n // 2) % n - n // 2
    hub, nodes, angle = hub_of(motion, hull, row, 0.0, 0.0), work.nodes[side], tree_state.hinge[row]
    turned = np.arctan2(end * (hub.z - nodes[2 * STRIDE + outermost]), end * (nodes[outermost] - hub.x))
    work.away[side] = (angle - turned) * tracks.sprockets.teeth / (2.0 * np.pi) - state.passed[side]
    load[:] = 0.0
    add_sprocket(tracks.sprockets, hub, angle, outermost, n, nodes, load)
    push_body(cuts, motion, hull, row, load)
    work.dissipation[TrackPart.TEETH] += load[WheelLoadOffset.DISSIPATION]
    work.stored[TrackPart.TEETH] += load[WheelLoadOffset.STORED]


@kernel
def _add_ground(tracks, state, side, road, path, work, dt):
    """Only the lower run, from the rearmost node to the foremost one, can touch the ground."""
    n = tracks.chain.links[side]
    begin, last = state.outermost[side], state.link[side, tracks.wheels.row.shape[1] - 1]
    if tracks.wheels.end < 0.0:
        begin, last = last, begin
    end = last + 1
    if begin < end:
        _add_stretch(tracks, state, side, road, path, begin, end, work, dt)
    else:
        _add_stretch(tracks, state, side, road, path, begin, n + 1, work, dt)
        _add_stretch(tracks, state, side, road, path, 1, end, work, dt)


@kernel
def _add_stretch(tracks, state, side, road, path, begin, end, work, dt):
    nodes, forces = state.nodes[side], work.nodes[side]
    find_on_path(path, nodes, begin, end, forces)
    dissipation, stored, touching = add_ground(
        tracks.ground, nodes, road.height[side], road.first, road.spacing, begin, end, forces, dt
    )
    work.dissipation[TrackPart.GROUND] += dissipation
    work.stored[TrackPart.GROUND] += stored
    work.touching[0] += touching


@kernel
def move_tracks(tracks, state, motion, gravity, work, dt):
    """Advance nodes and tensioners by dt."""
    for side in range(2):
        move_nodes(tracks.chain, tracks.chain.links[side], state.nodes[side], motion, gravity, work.nodes[side], dt)
        move_tensioner(tracks.tensioner, state.tensioner, side, work.push[side], dt)


@kernel
def wheel_below_road(tracks, road, path, motion):
    """Return whether the hub of any road wheel lies below the road, where its links know no way out."""
    for side in range(2):
        for k in range(tracks.wheels.row.shape[1]):
            if tracks.wheels.run[side, k] == LOWER_RUN:
                hub = motion_vector(motion, MotionOffset.ORIGIN, tracks.wheels.row[side, k])
                if hub[2] < road_height(road, side, path_distance(path, hub[0], hub[1], path.distance[0])):
                    return True
    return False


@kernel
def track_skips(work):
    """Return whether a pin has left its gap for another."""
    return abs(work.away[0]) > MESHED or abs(work.away[1]) > MESHED
