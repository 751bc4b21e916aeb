"""The tables of the documents about vehicles: those that are shipped, and what their files hold."""

from functools import partial

from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.drawings.vehicle_table import Figure, Parameter, figures, parameters
from trackvib_sim.vehicle.vehicle_file import read_vehicle


def vehicles():
    """The vehicles that come with the package."""
    rows = [("vehicle", "is")]
    for name in vehicle_names():
        vehicle, _ = read_vehicle(find_vehicle(name))
        rows.append((f"[{name}](vehicles/{name}.md)", vehicle.description))
    return rows


def figures_of(name):
    """Quantities derived from the parameters of a shipped vehicle."""
    return [Figure._fields, *figures(read_vehicle(find_vehicle(name))[0])]


def parameters_of(name):
    """Every item of a shipped vehicle file."""
    rows = [Parameter._fields]
    for section, items in parameters(find_vehicle(name).read_text(encoding="utf-8")).items():
        rows += [(f"**{section}**",) + ("",) * 4, *items]
    return rows


TABLES = {"vehicles": vehicles}
for _name in vehicle_names():
    TABLES[f"figures of {_name}"] = partial(figures_of, _name)
    TABLES[f"parameters of vehicle {_name}"] = partial(parameters_of, _name)
