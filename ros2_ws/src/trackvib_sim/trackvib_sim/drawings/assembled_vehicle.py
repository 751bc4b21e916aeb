"""The vehicle as it stands at the beginning of a run-in, tracks laid, for drawings and tables."""

from typing import NamedTuple

import numpy as np

from ..rui.reference.placement import place_bodies
from ..rui.sweeps.tree import to_table
from ..vehicle.body_tree import LEFT, SIDES, build_body_table, idler_name
from ..vehicle.system import Operation, build_system, new_state
from ..vehicle.tracks.initial import assemble_tracks
from ..vehicle.tracks.nodes import STRIDE


class AssembledVehicle(NamedTuple):
    """A standing vehicle with its tracks laid, global axes."""

    vehicle: object  # parameters.Vehicle
    sprockets: object  # tracks.sprockets.Sprockets
    hub: dict  # body name -> place of its origin (3,), that of the idlers with their tensioners' travel, m
    number: dict  # body name -> number of its hinge
    sprocket_angle: float  # of the left one, rad
    travel: np.ndarray  # (2,) of the idlers along x, left and right, m
    pins: tuple  # of the left track and the right one, (n, 3) each, m
    mass: float  # of everything, kg
    centre: np.ndarray  # (3,) of mass of everything, m


def assemble_vehicle(vehicle):
    """Return a vehicle (`parameters.Vehicle`) as `AssembledVehicle`.

    Raises
    ------
    TrackDoesNotFit
        The links do not close round the running gear.
    """
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    state = new_state(system)
    assemble_tracks(vehicle, system, state, 0.0, 0.0)
    bodies = build_body_table(vehicle)
    placed = place_bodies(bodies, to_table(system.tree, state.tree))
    hub = {body.name: origin for body, origin in zip(bodies, placed.origin, strict=True)}
    for side in SIDES:
        hub[idler_name(side)] = hub[idler_name(side)] + (state.tracks.tensioner.travel[side], 0.0, 0.0)
    centres = placed.origin + np.stack([turn @ body.centre for turn, body in zip(placed.rotation, bodies, strict=True)])
    links, nodes = system.tracks.chain.links, state.tracks.nodes
    pins = tuple(nodes[side].reshape(-1, STRIDE)[:3, 1 : links[side] + 1].T for side in SIDES)
    masses = [body.mass for body in bodies] + [vehicle.tracks.shoe_mass] * sum(map(len, pins))
    places = np.concatenate((centres, *pins))
    return AssembledVehicle(
        vehicle=vehicle,
        sprockets=system.tracks.sprockets,
        hub=hub,
        number={body.name: body.hinge.number for body in bodies if body.hinge is not None},
        sprocket_angle=float(state.tree.hinge[system.tracks.sprockets.row[LEFT]]),
        travel=system.tracks.tensioner.fitted,
        pins=pins,
        mass=sum(masses),
        centre=np.average(places, axis=0, weights=masses),
    )
