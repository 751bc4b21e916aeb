"""The command line's run of the closed loop: `trackvib run`."""

import sys

import click

from ..analysis.settling import SHORTEST_MEASURING, SHORTEST_SETTLING
from .driving_options import driving_options, loop_option
from .endings import fail
from .option_types import FiniteRange, WholeRange, law_option


@click.command()
@driving_options
@loop_option("duration", type=FiniteRange(SHORTEST_SETTLING + SHORTEST_MEASURING, 3600.0, "s"))
@loop_option("law", law_option)
@loop_option("law_parameters", metavar="NAME=VALUE,...")
@loop_option("control_rate", type=WholeRange(10, 10_000, "Hz"))
@loop_option("measure_rate", type=WholeRange(0, 1000, "Hz"), metavar="HZ")
@loop_option("realtime_priority", type=WholeRange(0, 99))
@loop_option("core", type=WholeRange(-1, 1023))
@click.option(
    "--params-file",
    "files",
    type=click.Path(exists=True, dir_okay=False),
    multiple=True,
    help="ROS 2 parameter file for any of the nodes; may be repeated, the last one wins. Options take precedence.  "
    "[default: none]",
)
@click.option(
    "--namespace", default="/", show_default=True, help="Namespace of the whole vehicle, including its clock."
)
@click.option(
    "--one-process", is_flag=True, help="Run simulator, road and controller in one process: same results, faster."
)
@click.option("--view", is_flag=True, help="Show the run live in a browser on this machine.")
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to create for the run.  [default: runs/<time>_<road>_<speed>]",
)
def run(out, files, namespace, one_process, view, **options):
    """Run the closed loop as four ROS 2 nodes; writes a bag, a summary and a picture."""
    if sys.stderr.isatty():
        click.echo("loading the simulation ...", err=True)
    from mr_mount_controller.node_base.parameters import ParameterError

    from ..nodes.namespace import full_namespace
    from .own_domain import Lookout
    from .result_folder import CommandError

    given = {name: value for name, value in {**options, "view": view or None}.items() if value is not None}
    try:
        namespace = full_namespace(namespace)
        choosing = dict(given=given, files=files, namespace=namespace, one_process=one_process, view=view)
        lookout = Lookout(namespace)
        if view:
            from .live_view import run_with_view  # imported late, as below

            run_with_view(choosing, out, lookout)
        else:
            from .run import run_loop  # imported late: neither --help nor the line above nor the lookout need wait

            run_loop(choosing, out, lookout)
    except (CommandError, ParameterError) as error:
        fail(error)
