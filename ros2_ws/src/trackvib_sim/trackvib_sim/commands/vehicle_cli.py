"""The command line's looks at a vehicle: `trackvib vehicle` and `trackvib modes`."""

import click

from .endings import fail
from .option_types import FiniteRange, on_command_line, vehicle_option


@click.command()
@vehicle_option
@click.option(
    "--current", type=FiniteRange(0.0, 10.0, "A"), default=1.0, show_default=True, help="Current of all coils in A."
)
@click.option(
    "--highest",
    type=FiniteRange(0.1, 1000.0, "Hz"),
    default=100.0,
    show_default=True,
    help="Highest frequency in the table, in Hz.",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False),
    default="modes.png",
    show_default=True,
    help="Picture of the lowest modes.",
)
def modes(vehicle, current, highest, out):
    """Print natural frequencies and damping of the stationary vehicle, and draw its modes."""
    from .modes import run_modes
    from .result_folder import CommandError  # imported late, as above

    try:
        run_modes(vehicle, current, highest, out)
    except (CommandError, ValueError, OSError) as error:
        fail(error)


@click.command()
@vehicle_option
@click.option(
    "--out", type=click.Path(dir_okay=False), default="vehicle.png", show_default=True, help="Drawing of the vehicle."
)
@click.option("--list", "listing", is_flag=True, help="Only list the included vehicles.")
@click.option("--schema", is_flag=True, help="Only print the JSON Schema of vehicle files, for editors.")
@click.pass_context
def vehicle(context, vehicle, out, listing, schema):
    """Print a vehicle's parameters, their sources and derived quantities, and draw it to scale."""
    given = [f"--{name}" for name in on_command_line(context, ("vehicle", "out"))]
    alone = ["--list"] * listing + ["--schema"] * schema
    if alone and len(alone + given) > 1:
        raise click.UsageError(f"{alone[0]} only prints, so it cannot be combined with {(alone + given)[1]}")
    from .result_folder import CommandError  # imported late, as above
    from .vehicle import list_vehicles, print_schema, run_vehicle

    try:
        if listing:
            list_vehicles()
        elif schema:
            print_schema()
        else:
            run_vehicle(vehicle, out)
    except (CommandError, ValueError, OSError) as error:
        fail(error)
