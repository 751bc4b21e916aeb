"""The command line's studies: `trackvib study NAME`."""

import os
import sys
from contextlib import contextmanager

import click

from ..road.classes import CLASSES
from ..vehicle.drive.limits import FASTEST
from .endings import INTERRUPTED, fail, say
from .option_types import FiniteRange, Known, Several, WholeRange, vehicle_option
from .result_folder import remove_if_empty
from .verbs import Verbs

SCENARIOS = ("e10", "c20", "run_up", "bump")  # those of studies.controllers, which takes long to import


@click.group(cls=Verbs)
def study():
    """Many runs of the whole vehicle, compared with published results or with each other."""


@contextmanager
def _ends_in_one_line(out):
    """Turn what can go wrong in a study into one line and an exit code."""
    from mr_mount_controller.laws import LawError  # imported late: --help need not wait for it

    from ..studies.workers import WorkersError

    new = not os.path.lexists(out)
    try:
        yield
    except (WorkersError, LawError, ValueError, OSError) as error:
        if new:
            remove_if_empty(out)
        fail(error)
    except KeyboardInterrupt:
        kept = f"finished runs are kept in {out}, the same command continues from there"
        say(f"interrupted; {'no run was finished' if new and remove_if_empty(out) else kept}")
        sys.exit(INTERRUPTED)


_SCHEDULER = click.option(
    "--scheduler",
    default=None,
    metavar="ADDRESS",
    help="Dask scheduler whose workers execute the runs.  [default: all cores of this machine]",
)


def _out(default, words="Folder of the study; finished runs in it are reused."):
    """The option for the folder that a study leaves."""
    return click.option("--out", type=click.Path(file_okay=False), default=default, show_default=True, help=words)


def _speeds(default):
    """The option for the speeds of a study's runs."""
    kind = Several(FiniteRange(0.0, FASTEST, "m/s", min_open=True))
    words = f"Speeds, {kind.each}."
    return click.option("--speeds", type=kind, default=default, show_default=True, metavar="V,V,...", help=words)


@study.command()
@click.option(
    "--classes",
    type=Several(Known(list(CLASSES))),
    default=",".join(CLASSES),
    show_default=True,
    metavar="A,B,...",
    help="ISO 8608 road classes.",
)
@_speeds("5,10,20")
@click.option(
    "--seeds",
    type=WholeRange(1, 1000),
    default=3,
    show_default=True,
    help="Runs per class and speed, each with its own road and track phase.",
)
@vehicle_option
@_SCHEDULER
@_out("table1")
def table1(classes, speeds, seeds, vehicle, scheduler, out):
    """Compare RMS accelerations over road classes and speeds with the paper's Table 1."""
    with _ends_in_one_line(out):
        from ..studies.paper.table1 import run_table1  # imported late, as above

        run_table1(classes, speeds, seeds, vehicle, scheduler, out)


@study.command()
@vehicle_option
@_SCHEDULER
@_out("figures", "Folder of the figures; finished runs in it are reused.")
def figures(vehicle, scheduler, out):
    """Reproduce the paper's other figures, and compare with a second solver."""
    with _ends_in_one_line(out):
        from ..studies.paper.figures import run_figures  # imported late, as above

        run_figures(vehicle, scheduler, out)


@study.command()
@click.option(
    "--laws",
    type=Several(click.STRING),
    default=None,
    metavar="LAW,LAW,...",
    help="Names of control laws, or package.module:Class.  [default: all installed laws]",
)
@click.option(
    "--scenarios",
    type=Several(Known(list(SCENARIOS))),
    default=",".join(SCENARIOS),
    show_default=True,
    metavar="NAME,NAME,...",
    help="Scenarios to run.",
)
@click.option(
    "--seeds",
    type=WholeRange(1, 1000),
    default=8,
    show_default=True,
    help="Runs per law and random scenario, each with its own road and track phase.",
)
@vehicle_option
@_SCHEDULER
@_out("controllers")
def controllers(laws, scenarios, seeds, vehicle, scheduler, out):
    """Compare every control law with constant currents: on roads, in an engine run-up and over a bump."""
    with _ends_in_one_line(out):
        from ..studies.controllers.study import run_controllers  # imported late, as above

        run_controllers(laws, scenarios, seeds, vehicle, scheduler, out)


@study.command()
@click.option(
    "--generations",
    type=WholeRange(1, 100000),
    default=None,
    help="Total number of generations of the search, including those already done.  [default: the plan's]",
)
@click.option(
    "--plan",
    type=click.Path(dir_okay=False),
    default=None,
    help="Plan file: parameters, bounds and effort.  [default: the included plan]",
)
@click.option(
    "--without",
    type=Several(Known(list(CLASSES))),
    default=(),
    metavar="A,B,...",
    help="Road classes whose rows are left out, so that `study table1` can predict them.  [default: none]",
)
@vehicle_option
@_SCHEDULER
@_out("calibration", "Folder of the study; an existing search in it is continued.")
def calibrate(generations, plan, without, vehicle, scheduler, out):
    """Fit uncertain parameters of the vehicle to the published rows of the paper's Table 1."""
    with _ends_in_one_line(out):
        from ..studies.calibration.study import run_calibrate  # imported late, as above

        run_calibrate(plan, vehicle, without, generations, scheduler, out)


@study.command()
@click.option(
    "--phases",
    type=WholeRange(1, 100),
    default=16,
    show_default=True,
    help="Runs per case, each with its own phase between the two tracks; variants have two of them.",
)
@_SCHEDULER
@_out("m113")
def m113(phases, scheduler, out):
    """Compare the M113 with the same vehicle in an independent code, and find the causes of differences."""
    with _ends_in_one_line(out):
        from ..studies.m113.study import run_m113  # imported late, as above

        run_m113(phases, scheduler, out)


@study.command()
@_speeds("2,5,8,10,12,15,20")
@vehicle_option
@_SCHEDULER
@_out("resistance")
def resistance(speeds, vehicle, scheduler, out):
    """Running resistance: force and power on level ground, and where the power is dissipated."""
    with _ends_in_one_line(out):
        from ..studies.resistance.study import run_resistance  # imported late, as above

        run_resistance(speeds, vehicle, scheduler, out)
