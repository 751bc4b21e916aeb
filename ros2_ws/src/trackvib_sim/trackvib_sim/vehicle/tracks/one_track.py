"""One track with all that it touches, given the records of `tracks`: its forces, and its nodes' step."""

from enum import IntEnum

import numpy as np

from ...numerics.angles import vector_angle
from ...numerics.compiled import inlined
from ...numerics.spatial import rotate
from ...rui.sweeps.articulated import apply_wrench
from .ground import add_ground, find_on_path
from .nodes import STRIDE, add_links, move_nodes, see_from_hull
from .rims import WheelLoadOffset, press_contacts, take_contacts
from .sprockets import add_sprocket
from .tensioner import move_tensioner, tensioner_energy
from .wheels import END, find_link, find_outermost, hub_of, hull_frame, list_contacts, push_body


class TrackPart(IntEnum):
    """Where energy is stored and dissipated in the tracks."""

    LINKS = 0
    GROUND = 1
    RIMS = 2
    TEETH = 3
    TENSIONERS = 4


@inlined
def add_track(tracks, state, side, tree_state, road, path, motion, cuts, work, dt, audit):
    """Add the forces of a side's track to the bodies of the tree, and prepare those on its own nodes.

    The shear of the ground under the shoes is advanced by dt. With `audit` heat and stored energy are booked: without,
    the compiler leaves out all that is done for them alone.
    """
    nodes = work.nodes[room_of(work, side)]
    see_from_hull(tracks.chain, tracks.chain.links[side], state.nodes[side], motion, nodes)
    dissipation, stored = add_links(tracks.chain, side, nodes)
    _book(work, TrackPart.LINKS, dissipation, stored, audit)
    add_wheels(tracks, state, side, motion, cuts, work, audit)
    add_teeth(tracks, state, side, tree_state, motion, cuts, work, audit)
    add_lower_run(tracks, state, side, road, path, work, dt, audit)


@inlined
def room_of(work, side):
    """Return the row of `TrackWork.nodes` that holds a side's results."""
    return min(side, work.nodes.shape[0] - 1)


@inlined
def _book(work, part, dissipation, stored, audit):
    if audit:
        work.dissipation[part] += dissipation
        work.stored[part] += stored


@inlined
def add_wheels(tracks, state, side, motion, cuts, work, audit):
    """Add what a side's wheels and its nodes do to each other."""
    wheels, hull, n, nodes = tracks.wheels, tracks.chain.hull, tracks.chain.links[side], work.nodes[room_of(work, side)]
    frame, contacts, load, count = hull_frame(motion, hull), work.contacts, work.load, 0
    for k in range(wheels.row.shape[1]):
        run, link = wheels.run[side, k], state.link[side, k]
        if run == END:
            hub = hub_of(motion, frame, wheels.row[side, k], state.tensioner.travel[side], state.tensioner.rate[side])
            link = find_outermost(wheels.end, nodes, link, n)
        else:
            hub = hub_of(motion, frame, wheels.row[side, k], 0.0, 0.0)
            link = find_link(run, hub.x, nodes, link, n)
        state.link[side, k] = link
        count = list_contacts(wheels, side, k, hub, link, n, nodes, contacts, count)
    press_contacts(contacts, count)
    first = 0
    for k in range(wheels.row.shape[1]):
        load[:] = 0.0
        take_contacts(contacts, first, contacts.end[k], n, nodes, load)
        first = contacts.end[k]
        push_body(cuts, frame, wheels.row[side, k], load)
        _book(work, TrackPart.RIMS, load[WheelLoadOffset.DISSIPATION], load[WheelLoadOffset.STORED], audit)
        if wheels.run[side, k] == END:
            work.push[side] = load[WheelLoadOffset.FORCE]
            dissipation, stored = tensioner_energy(tracks.tensioner, state.tensioner, side)
            _book(work, TrackPart.TENSIONERS, dissipation, stored, audit)
            # the rim's force acts at the shifted hub; the slide carries its moment about the idler's own place
            travel = state.tensioner.travel[side]
            moment = (0.0, -travel * load[WheelLoadOffset.FORCE + 2], travel * load[WheelLoadOffset.FORCE + 1])
            apply_wrench(cuts, hull, (0.0, 0.0, 0.0), rotate(frame.axes, moment))


@inlined
def add_teeth(tracks, state, side, tree_state, motion, cuts, work, audit):
    """Add what a side's sprocket and its nodes do to each other."""
    hull, n, load, row = tracks.chain.hull, tracks.chain.links[side], work.load, tracks.sprockets.row[side]
    end, before, frame = tracks.sprockets.end, state.outermost[side], hull_frame(motion, hull)
    nodes = work.nodes[room_of(work, side)]
    outermost = find_outermost(end, nodes, before, n)
    state.outermost[side] = outermost
    # steps of a few pins at most, where the numbers begin anew as well
    state.passed[side] += (outermost - before + n + n // 2) % n - n // 2
    hub, angle = hub_of(motion, frame, row, 0.0, 0.0), tree_state.hinge[row]
    turned = vector_angle(end * (nodes[outermost] - hub.x), end * (hub.z - nodes[2 * STRIDE + outermost]))
    work.away[side] = (angle - turned) * tracks.sprockets.teeth / (2.0 * np.pi) - state.passed[side]
    load[:] = 0.0
    add_sprocket(tracks.sprockets, hub, angle, outermost, n, nodes, load)
    push_body(cuts, frame, row, load)
    _book(work, TrackPart.TEETH, load[WheelLoadOffset.DISSIPATION], load[WheelLoadOffset.STORED], audit)


@inlined
def add_lower_run(tracks, state, side, road, path, work, dt, audit):
    """Add the ground's forces: only the lower run, from the rearmost node to the foremost one, can touch it."""
    n = tracks.chain.links[side]
    begin, last = state.outermost[side], state.link[side, tracks.wheels.row.shape[1] - 1]
    if tracks.wheels.end < 0.0:
        begin, last = last, begin
    end = last + 1
    stop = end if begin < end else n + 1
    _add_stretch(tracks, state, side, road, path, begin, stop, work, dt, audit)
    if stop > end:  # the numbers begin anew within the run
        _add_stretch(tracks, state, side, road, path, 1, end, work, dt, audit)


@inlined
def _add_stretch(tracks, state, side, road, path, begin, end, work, dt, audit):
    nodes, forces = state.nodes[side], work.nodes[room_of(work, side)]
    find_on_path(path, nodes, begin, end, forces)
    dissipation, stored, touching = add_ground(
        tracks.ground, nodes, road.height[side], road.first, road.spacing, begin, end, forces, dt
    )
    _book(work, TrackPart.GROUND, dissipation, stored, audit)
    work.touching[0] += touching


@inlined
def move_track(tracks, state, side, motion, gravity, work, dt):
    """Advance nodes and tensioner of a side by dt."""
    n, nodes = tracks.chain.links[side], state.nodes[side]
    move_nodes(tracks.chain, n, nodes, motion, gravity, work.nodes[room_of(work, side)], dt)
    move_tensioner(tracks.tensioner, state.tensioner, side, work.push[side], dt)
