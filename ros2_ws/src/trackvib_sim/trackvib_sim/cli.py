"""The command line: `trackvib VERB`."""

import signal
import sys
from contextlib import contextmanager

import click
from mr_mount_controller.laws import known_laws
from mr_mount_controller.node_base.plain_text import plain_line

from .commands.analyze_cli import analyze
from .commands.bag_cli import bag
from .commands.endings import fail, say
from .commands.lasting_output import OutputLost, lasting_output
from .commands.mount_cli import mount
from .commands.option_types import INTERRUPTED, FiniteRange, known_law, vehicle_option
from .commands.replay_cli import replay
from .commands.road_cli import road
from .commands.study_cli import study
from .commands.view_cli import view


class _Verbs(click.Group):
    """Ctrl-C at any moment ends a verb in one line, with the exit code that shells know it by.

    So does standard output that breaks off, once the verb's work is done.
    """

    def make_context(self, *arguments, **extra):
        with _plain_errors():
            return super().make_context(*arguments, **extra)

    def invoke(self, context):
        try:
            with _plain_errors(), lasting_output():
                return super().invoke(context)
        except KeyboardInterrupt:
            say("interrupted")
            sys.exit(INTERRUPTED)
        except OutputLost as error:
            fail(error)


@contextmanager
def _plain_errors():
    """Make a plain line of what is wrong with the arguments: it quotes them, and they may name a file."""
    try:
        yield
    except click.ClickException as error:
        error.message = plain_line(error.message)
        raise


@click.group(cls=_Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
def main():
    """Vibration laboratory for a tracked vehicle's powertrain on magnetorheological mounts."""
    # An orderly end, as on Ctrl-C, when the terminal is closed or the process is asked to end; a job started in the
    # background of a script would otherwise ignore Ctrl-C.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: _interrupt())


def _interrupt():
    raise KeyboardInterrupt


@main.command()
@vehicle_option
@click.option(
    "--road",
    default="E",
    show_default=True,
    metavar="CLASS|FILE",
    help="Class by ISO 8608, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag.",
)
@click.option(
    "--speed",
    type=FiniteRange(-25.0, 25.0),
    default=10.0,
    show_default=True,
    help="Speed in m/s; below 0 backwards.",
)
@click.option(
    "--drive",
    type=click.Path(exists=True, dir_okay=False),
    default=None,
    help="Drive file: speed, path and engine speed over time or distance, in place of --speed.",
)
@click.option("--gears", is_flag=True, help="Engine speed follows the vehicle's, through the vehicle file's gears.")
@click.option("--duration", type=FiniteRange(0.1, 3600.0), default=10.0, show_default=True, help="Simulated time in s.")
@click.option(
    "--law",
    default="passive",
    show_default=True,
    callback=known_law,
    help=f"Control law: {', '.join(known_laws())}, or package.module:Class.",
)
@click.option("--seed", type=click.IntRange(0, 10**9), default=1, show_default=True, help="Seed of the road.")
@click.option(
    "--physics-rate",
    type=click.IntRange(1000, 200_000),
    default=10_000,
    show_default=True,
    help="Rate of the physics steps in Hz; `trackvib vehicle` tells the one that a vehicle needs.",
)
@click.option(
    "--one-process", is_flag=True, help="Simulator, road and controller in one process: the same results, sooner."
)
@click.option("--view", is_flag=True, help="Show the run in a browser on this machine while it goes on.")
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to make for the run.  [default: runs/<time>_<road>_<speed>]",
)
def run(out, **choices):
    """Run the closed loop as four ROS 2 nodes; leaves a bag, a summary and a picture."""
    from .commands.result_folder import CommandError
    from .commands.run import Choices, run_loop  # imported late: --help need not wait for it

    try:
        if choices["view"]:
            from .commands.live_view import run_with_view

            run_with_view(Choices(**choices), out)
        else:
            run_loop(Choices(**choices), out)
    except CommandError as error:
        fail(error)


@main.command()
@vehicle_option
@click.option(
    "--current", type=FiniteRange(0.0, 10.0), default=1.0, show_default=True, help="Current of all coils in A."
)
@click.option(
    "--highest",
    type=FiniteRange(0.1, 1000.0),
    default=100.0,
    show_default=True,
    help="Highest frequency of the table in Hz.",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False),
    default="modes.png",
    show_default=True,
    help="Picture of the lowest oscillations.",
)
def modes(vehicle, current, highest, out):
    """Print the standing vehicle's natural frequencies and damping, and draw its modes."""
    from .commands.modes import run_modes
    from .commands.result_folder import CommandError  # imported late, as above

    try:
        run_modes(vehicle, current, highest, out)
    except (CommandError, ValueError, OSError) as error:
        fail(error)


@main.command()
@vehicle_option
@click.option(
    "--out", type=click.Path(dir_okay=False), default="vehicle.png", show_default=True, help="Drawing of the vehicle."
)
@click.option("--list", "listing", is_flag=True, help="Only list the vehicles that come with the package.")
@click.option("--schema", is_flag=True, help="Only print the JSON Schema of vehicle files, for editors.")
def vehicle(vehicle, out, listing, schema):
    """Print a vehicle's parameters with their sources and what follows from them, and draw it to scale."""
    from .commands.result_folder import CommandError  # imported late, as above
    from .commands.vehicle import list_vehicles, print_schema, run_vehicle

    try:
        if listing:
            list_vehicles()
        elif schema:
            print_schema()
        else:
            run_vehicle(vehicle, out)
    except (CommandError, ValueError, OSError) as error:
        fail(error)


main.add_command(analyze)
main.add_command(bag)
main.add_command(mount)
main.add_command(replay)
main.add_command(study)
main.add_command(road)
main.add_command(view)

if __name__ == "__main__":
    main(prog_name="trackvib")
