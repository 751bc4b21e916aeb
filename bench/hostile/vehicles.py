"""Vehicle files with wild numbers: of the shipped one, one to three numbers are scaled.

By 0, by something tiny, huge or negative, or by a factor near one. Each file is read, its vehicle built, its tracks
laid and its static equilibrium sought.
"""

import copy
import math

import numpy as np
import yaml
from trackvib_sim.data import find_vehicle
from trackvib_sim.drawings.assembled_vehicle import assemble_vehicle
from trackvib_sim.vehicle.equilibrium import NoEquilibrium, static_equilibrium
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.tracks.layout import TrackDoesNotFit
from trackvib_sim.vehicle.vehicle_file import VehicleFileError, parse_vehicle

from .trial import Wrong

KNOWN = (VehicleFileError, TrackDoesNotFit, NoEquilibrium)
REFUSALS = (ValueError,)
MILD = (0.5, 0.9, 0.99, 1.01, 1.1, 2.0)
WILD = (0.0, 1e-300, 1e-12, 1e-3, 0.1, 10.0, 1e3, 1e12, 1e300, -1.0, -1e-12, -1e12)


def trials(chance, count):
    """Yield so many vehicle files."""
    content = yaml.safe_load(find_vehicle().read_text(encoding="utf-8"))
    places = _numbers(content)
    for _ in range(count):
        new, done = _wild(content, places, chance)
        text = yaml.safe_dump(new, sort_keys=False)
        yield done, lambda text=text: _attempt(text)


def _numbers(content, path=()):
    """Return the places of all numbers in a vehicle file that are values of quantities: keys and indices."""
    if isinstance(content, (dict, list)):
        inner = content.items() if isinstance(content, dict) else enumerate(content)
        return [place for key, each in inner for place in _numbers(each, (*path, key))]
    return [path] if isinstance(content, (int, float)) and "value" in path else []


def _wild(content, places, chance):
    """Return a copy with one to three numbers scaled, and what was done."""
    new, done = copy.deepcopy(content), []
    for *path, last in chance.sample(places, chance.randint(1, 3)):
        factor = chance.choice(chance.choice((MILD, WILD)))
        holder = new
        for step in path:
            holder = holder[step]
        holder[last] *= factor
        done.append(f"{path[0]}.{path[1]} x {factor:g}")
    return new, ", ".join(done)


def _attempt(text):
    try:
        vehicle = parse_vehicle(text, "wild.yaml")
        assembled = assemble_vehicle(vehicle)
        state = static_equilibrium(build_system(vehicle, Operation(0.0, 0.0, False), 1e-4), 1.0)
    except ValueError as error:
        if not isinstance(error, KNOWN) and "must be" not in str(error):
            raise Wrong(f"does not say what is accepted: {error}") from None
        raise
    if not all(map(math.isfinite, (assembled.mass, *np.concatenate(assembled.pins).flat, *state.tree.hinge.flat))):
        raise Wrong("a number that is not finite")
    return "a vehicle"
