"""The parts of a physics step, each in a compiled loop of its own, for `bench/vehicle.py --parts`.

A part is repeated on the records of a vehicle that drives, in steps of no time: nothing moves on, so that every
repetition does the same work. What they leave of the whole step are calls and checks.
"""

from copy import deepcopy

from trackvib_sim.numerics.compiled import kernel
from trackvib_sim.rui.sweeps.articulated import open_cuts
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.kinematics import update_motion
from trackvib_sim.rui.sweeps.riccati import solve_accelerations
from trackvib_sim.simulation.sensing import measure
from trackvib_sim.simulation.step import add_forces
from trackvib_sim.vehicle.drive.drive import end_drive_step
from trackvib_sim.vehicle.tracks.nodes import add_links, see_from_hull
from trackvib_sim.vehicle.tracks.one_track import add_lower_run, add_teeth, add_wheels, move_track
from trackvib_sim.vehicle.tracks.tracks import advance_tracks, new_track_work

NO_TIME = 1e-12  # s


@kernel
def _motion(run, count):
    for _ in range(count):
        update_motion(run[0].tree, run[1].tree, run[3].motion)


@kernel
def _opening(run, count):
    system, work = run[0], run[3]
    for _ in range(count):
        open_cuts(system.tree, work.motion, work.torques, work.cuts)


@kernel
def _sweeps(run, count):
    system, work = run[0], run[3]
    for _ in range(count):
        open_cuts(system.tree, work.motion, work.torques, work.cuts)
        solve_accelerations(system.tree, work.motion, work.cuts, work.response)


@kernel
def _hull_axes(run, count):
    system, state, work = run[0], run[1], run[3]
    for _ in range(count):
        for side in range(2):
            nodes, n = state.tracks.nodes[side], system.tracks.chain.links[side]
            see_from_hull(system.tracks.chain, n, nodes, work.motion, work.tracks.nodes[side])


@kernel
def _links(run, count):
    for _ in range(count):
        for side in range(2):
            add_links(run[0].tracks.chain, side, run[3].tracks.nodes[side])


@kernel
def _wheels(run, count):
    system, state, work = run[0], run[1], run[3]
    for _ in range(count):
        for side in range(2):
            add_wheels(system.tracks, state.tracks, side, work.motion, work.cuts, work.tracks, False)


@kernel
def _teeth(run, count):
    system, state, work = run[0], run[1], run[3]
    for _ in range(count):
        for side in range(2):
            add_teeth(system.tracks, state.tracks, side, state.tree, work.motion, work.cuts, work.tracks, False)


@kernel
def _ground(run, count):
    system, state, road, work = run[0], run[1], run[2], run[3]
    for _ in range(count):
        for side in range(2):
            add_lower_run(system.tracks, state.tracks, side, road, state.drive.path, work.tracks, NO_TIME, False)


@kernel
def _tracks(run, count):
    system, state, road, work = run[0], run[1], run[2], run[3]
    for _ in range(count):
        advance_tracks(
            system.tracks,
            state.tracks,
            state.tree,
            road,
            state.drive.path,
            work.motion,
            system.tree.gravity,
            work.cuts,
            work.tracks,
            NO_TIME,
        )


@kernel
def _forces(run, count):
    system, state, road, work = run[0], run[1], run[2], run[3]
    for _ in range(count):
        add_forces(system, state, road, work)


@kernel
def _move(run, count):
    system, state, work = run[0], run[1], run[3]
    for _ in range(count):
        for side in range(2):
            move_track(system.tracks, state.tracks, side, work.motion, system.tree.gravity, work.tracks, NO_TIME)


@kernel
def _integrate(run, count):
    system, state, work = run[0], run[1], run[3]
    for _ in range(count):
        integrate(system.tree, state.tree, work.response, NO_TIME)
        end_drive_step(system.drive, state.drive, state.tree.position[0, 0], state.tree.position[0, 1], NO_TIME)


@kernel
def _measure(run, count):
    for _ in range(count):
        measure(run[3], run[4], run[5], 0)


_KERNELS = {
    "motion": _motion,
    "opening": _opening,
    "sweeps": _sweeps,
    "hull axes": _hull_axes,
    "links": _links,
    "wheels": _wheels,
    "teeth": _teeth,
    "ground": _ground,
    "tracks": _tracks,
    "forces": _forces,
    "move": _move,
    "integrate": _integrate,
    "measure": _measure,
}


def part_tasks(run, count):
    """Return functions, by name, that repeat a part `count` times.

    `run` holds system, state, road, working room, points and sample of a `Simulation`; each part has a copy.
    """
    system, state, road, work, points, sample = run
    work = work._replace(tracks=new_track_work(system.tracks, kept=2))
    system = system._replace(dt=NO_TIME)
    _forces((system, deepcopy(state), road, work, points, sample), 1)
    tasks = {}
    for name, repeat in _KERNELS.items():
        own = (system, deepcopy(state), road, deepcopy(work), deepcopy(points), sample)
        repeat(own, 1)
        tasks[name] = lambda repeat=repeat, own=own: repeat(own, count)
    return tasks


def parts_of_step(times, step):
    """Return the parts of a step, by name, given the times of the tasks and that of a whole step in the same unit."""
    loads = times["forces"] - times["tracks"] - times["motion"] - times["opening"]
    parts = {
        "body tree: motion": times["motion"],
        "body tree: sweeps": times["sweeps"],
        "body tree: step, and drive": times["integrate"],
        "wheels": times["wheels"],
        "links": times["links"],
        "ground": times["ground"],
        "sprockets": times["teeth"],
        "places seen from the hull": times["hull axes"],
        "shoes' step": times["move"],
        "mounts, springs, engine, driver": loads,
        "sensors": times["measure"],
    }
    parts["calls and checks"] = step - sum(parts.values())
    return parts
