"""`trackvib vehicle`: a vehicle's parameters with their sources, what follows from them, and its drawing to scale.

Also the list of the vehicles that come with the package, and the schema of their files.
"""

import json
from collections import Counter
from pathlib import Path

from mr_mount_controller.node_base.plain_text import readable
from rich.table import Table
from rich.text import Text

from ..console import Terminal
from ..data import find_vehicle, vehicle_names
from ..drawings.assembled_vehicle import assemble_vehicle
from ..drawings.vehicle_table import Figure, Parameter, figures, parameters
from ..vehicle.body_tree import FRONT, drive_end
from ..vehicle.parameters import Vehicle
from ..vehicle.plausibility import doubts
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import whole_or_none

SCHEMA = "https://json-schema.org/draft/2020-12/schema"


def run_vehicle(name_or_file, picture):
    """Print the tables of a vehicle, by its name or file, of the default one if that is None, and draw it.

    Raises
    ------
    ValueError
        The file cannot be used, the tracks do not fit, it cannot stand, or the picture's folder does not exist.
    CommandError
        The picture cannot be written.
    """
    if not Path(picture).absolute().parent.is_dir():
        raise ValueError(f"picture {picture}: its folder must exist")
    path = find_vehicle(name_or_file)
    vehicle, text = read_vehicle(path)
    tables = _parameters(text), _figures(vehicle)
    out = Terminal()
    out.print(f"vehicle: {path}", soft_wrap=True)  # as the title of a table it would be broken in its middle
    for table in tables:
        out.print(table)
    for doubt in doubts(vehicle):
        out.print(f"warning: {doubt}", soft_wrap=True)
    from ..drawings.vehicle_picture import vehicle_picture  # imported late: the tables are there already

    with whole_or_none(Path(picture)) as (file,):
        vehicle_picture(vehicle, file)
    out.print(f"drawing: {picture}")


def list_vehicles():
    """Print a table of the vehicles that come with the package."""
    table = Table("name", "mass", "stations", "drive", "mounts", "description", show_lines=True)
    for name in vehicle_names():
        vehicle, _ = read_vehicle(find_vehicle(name))
        mounts = Counter(vehicle.mount_types[mount.type].kind for mount in vehicle.mounts.values())
        table.add_row(
            name,
            f"{1e-3 * assemble_vehicle(vehicle).mass:.1f} t",
            str(vehicle.swing_arms.stations),
            "front" if drive_end(vehicle) == FRONT else "rear",
            ", ".join(f"{count} {kind}" for kind, count in mounts.items()),
            vehicle.description,
        )
    Terminal().print(table)


def print_schema():
    """Print the JSON Schema of a vehicle file."""
    print(json.dumps({"$schema": SCHEMA, **Vehicle.model_json_schema()}, indent=2))


def _parameters(text):
    table = Table(*Parameter._fields)
    for section, items in parameters(text).items():
        table.add_section()
        table.add_row(Text(readable(section), style="bold"))
        for item in items:
            table.add_row(*item)
    return table


def _figures(vehicle):
    table = Table(*Figure._fields, title="Derived quantities")
    for figure in figures(vehicle):
        table.add_row(*figure)
    return table
