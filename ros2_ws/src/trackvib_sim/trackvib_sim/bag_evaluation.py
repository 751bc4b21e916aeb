"""`trackvib analyze`: bags are read and measured one after the other; tables on the screen, files in one new folder."""

import shutil
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.table import Table

from .analysis.bag_analysis import analyse
from .analysis.bag_tables import write_tables
from .analysis.levels import WEIGHTINGS
from .analysis.report.excerpt import excerpt
from .analysis.report.page import write_report
from .analysis.summary import AXES, SENSORS
from .bags.recording import read_recording
from .bags.writing import BagError


class EvaluationError(RuntimeError):
    """Bags that cannot be analysed, or results that cannot be written."""


def perform(bags, settle, out):
    """Analyse some bags; see `analyze_cli`.

    Raises
    ------
    EvaluationError
        A bag cannot be read or is too short, or the folder exists or cannot be written. No folder is left then.
    """
    console = Console(highlight=False)
    with _new_folder(out) as folder:
        analyses, excerpts = [], []
        with _progress(console) as progress:
            for bag in bags:
                recording = read_recording(bag, _follower(progress, f"reading {bag}"))
                try:
                    analyses.append(analyse(recording, settle, _follower(progress, f"measuring {bag}")))
                except ValueError as error:
                    raise EvaluationError(f"bag {bag!r}: {error}") from None
                excerpts.append(excerpt(recording, analyses[-1]))
        write_tables(analyses, folder)
        write_report(excerpts, folder / "report.html")
    for number, analysis in enumerate(analyses, 1):
        told = f"{analysis.duration:g} s, of which {analysis.measured:g} s count, after {analysis.settle:g} s"
        console.print(f"bag {number}: {analysis.bag}: {told}", soft_wrap=True)
        for note in analysis.notes:
            console.print(f"  {note}", soft_wrap=True)
    for table in (_levels, _lines, _mounts):
        console.print(table(analyses))
    console.print(f"left in {folder}: {', '.join(sorted(each.name for each in folder.iterdir()))}", soft_wrap=True)


@contextmanager
def _new_folder(out):
    """Make the folder for the results; it is taken away again if they do not come about."""
    folder = Path(out) if out is not None else Path("analyses") / f"{datetime.now():%Y%m%dT%H%M%S}"
    try:
        folder.mkdir(parents=True)
    except FileExistsError:
        raise EvaluationError(f"{str(folder)!r} exists already; nothing is overwritten, choose another --out") from None
    except OSError as error:
        raise EvaluationError(f"{str(folder)!r} cannot be made: {error.strerror}") from None
    try:
        yield folder
    except BaseException as error:
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, BagError):
            raise EvaluationError(str(error)) from None
        if isinstance(error, OSError):
            raise EvaluationError(f"{str(folder)!r} cannot be written: {error.strerror or error}") from None
        raise


def _progress(console):
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console)


def _follower(progress, description):
    task = progress.add_task(description)
    return lambda done, total: progress.update(task, completed=done, total=total)


def _levels(analyses):
    table = _table("acceleration, band-limited (RMS, peak) and weighted by ISO 2631-1 (the rest), m/s²")
    for name in ("RMS", "peak", "RMS", "crest factor", "MTVV", "VDV m/s^1.75"):
        table.add_column(name, justify="right")
    for number, analysis in enumerate(analyses, 1):
        for sensor, axes in analysis.sensors.items():
            for axis, n in axes.items():
                weighted = f"{WEIGHTINGS[AXES.index(axis)]} {n.rms_weighted:.3f}"
                rest = (f"{value:.3f}" for value in (n.crest_factor, n.mtvv, n.vdv))
                table.add_row(str(number), f"{sensor} {axis}", f"{n.rms:.3f}", f"{n.peak:.3f}", weighted, *rest)
        table.add_section()
    return table


def _lines(analyses):
    table = _table("RMS about lines with a known cause, m/s²")
    table.add_column("Hz", justify="right")
    for sensor in SENSORS:
        for axis in AXES:
            table.add_column(f"{sensor}\n{axis}", justify="right")
    for number, analysis in enumerate(analyses, 1):
        for line in analysis.lines:
            levels = [f"{level:.2f}" for axes in line.rms.values() for level in axes.values()]
            table.add_row(str(number), line.name, f"{line.frequency:.1f}", *levels)
        table.add_section()
    return table


def _mounts(analyses):
    table = _table("mounts: vertical travel and force about their means, current")
    for name in ("mm RMS", "peak", "kN RMS", "peak", "J heat", "A mean", "RMS", "least", "most"):
        table.add_column(name, justify="right")
    for number, analysis in enumerate(analyses, 1):
        for side, mount in analysis.mounts.items():
            z, current = mount.axes["z"], mount.current
            numbers = (1e3 * z.travel_rms, 1e3 * z.travel_peak, 1e-3 * z.force_rms, 1e-3 * z.force_peak,
                       mount.energy_dissipated, current.mean, current.rms, current.least, current.greatest)  # fmt: skip
            table.add_row(str(number), side, *(f"{each:.2f}" for each in numbers))
        table.add_section()
    return table


def _table(title):
    table = Table(title=title, title_justify="left")
    table.add_column("bag")
    table.add_column("")
    return table
