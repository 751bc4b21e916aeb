"""`trackvib vehicle`: a vehicle's parameters with their sources, what follows from them, and its drawing to scale."""

from pathlib import Path

from mr_mount_controller.node_base.plain_text import readable
from rich.table import Table
from rich.text import Text

from ..console import Terminal
from ..data import find_vehicle
from ..drawings.vehicle_picture import vehicle_picture
from ..drawings.vehicle_table import Figure, Parameter, figures, parameters
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import whole_or_none


def run_vehicle(vehicle_file, picture):
    """Print the tables of a vehicle file, or of the one that comes with the package if that is None, and draw it.

    Raises
    ------
    ValueError
        The file cannot be used, the tracks do not fit, or the picture's folder does not exist.
    CommandError
        The picture cannot be written.
    """
    if not Path(picture).absolute().parent.is_dir():
        raise ValueError(f"picture {picture}: its folder must exist")
    path = find_vehicle(vehicle_file)
    vehicle, text = read_vehicle(path)
    with whole_or_none(Path(picture)) as (file,):
        vehicle_picture(vehicle, file)
    out = Terminal()
    out.print(_parameters(text, f"Vehicle {path}"))
    out.print(_figures(vehicle))
    out.print(f"drawing: {picture}")


def _parameters(text, title):
    table = Table(*Parameter._fields, title=title)
    for section, items in parameters(text).items():
        table.add_section()
        table.add_row(Text(readable(section), style="bold"))
        for item in items:
            table.add_row(*item)
    return table


def _figures(vehicle):
    table = Table(*Figure._fields, title="What follows from these")
    for figure in figures(vehicle):
        table.add_row(*figure)
    return table
