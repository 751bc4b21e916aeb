"""`trackvib analyze`: bags are read and measured one after the other; tables on the screen, files in one new folder."""

from contextlib import contextmanager
from datetime import datetime
from math import isnan
from os.path import realpath
from pathlib import Path

from rich.table import Table

from ..analysis.analyse import analyse
from ..analysis.bag_tables import write_tables
from ..analysis.clocks.time_base import on_one_time_base
from ..analysis.levels import WEIGHTINGS
from ..analysis.measured import in_unit
from ..analysis.numbers import AXES, SENSORS
from ..analysis.placement import in_vehicle_axes
from ..analysis.report.page import write_report
from ..analysis.report.report_data import build_report_data
from ..bags.files import bag_files
from ..bags.reading import read_recording
from ..bags.sources import is_csv
from ..console import Terminal, progress_on
from .result_folder import CommandError, all_or_nothing


def run_analyze(bags, settle, interval, speed_band, out, time, unit, sources):
    """Analyse some bags; see `analyze_cli`.

    Raises
    ------
    BagError, CommandError
        A bag is given twice, cannot be read or is too short, or the folder exists or cannot be written. No folder is
        left then.
    """
    console = Terminal()
    folder = out or Path("analyses") / f"{datetime.now():%Y%m%dT%H%M%S}"
    with all_or_nothing(folder) as folder:
        require_different(bags)
        analyses, report_data_list = [], []
        with progress_on(console) as progress:
            for bag in bags:
                recording = read(bag, progress, time, unit, sources)
                analysis, report_data = measure(recording, bag, progress, settle, interval, speed_band)
                analyses.append(analysis)
                report_data_list.append(report_data)
                del recording  # and with it large temporary files, before the next one makes its own
        write_tables(analyses, folder)
        write_report(report_data_list, folder / "report.html")
    for number, analysis in enumerate(analyses, 1):
        length = f"{analysis.duration:g} s, of which {analysis.measured:g} s count, after {analysis.settle:g} s"
        console.print(f"recording {number}: {analysis.bag}: {length}", soft_wrap=True)
        for note in analysis.notes:
            console.print(f"  {note}", soft_wrap=True)
    for table in (_levels(analyses), _speeds(analyses), _lines(analyses), _mounts(analyses)):
        if table.row_count:
            console.print(table)
    console.print(f"written to {folder}: {', '.join(sorted(each.name for each in folder.iterdir()))}", soft_wrap=True)


def read(bag, progress, time, unit, sources):
    """Return the recording in a bag on one time base; raises `BagError`, or `CommandError` if that cannot be."""
    recording = read_recording(bag, _reporter(progress, f"reading {bag}"), time, sources)
    with _named(bag):
        return on_one_time_base(in_vehicle_axes(in_unit(recording, unit), sources))


def measure(recording, bag, progress, settle, interval, speed_band):
    """Return `Analysis` and `ReportData` of a recording; raises `CommandError` if it cannot be measured."""
    with _named(bag):
        analysis = analyse(recording, settle, _reporter(progress, f"measuring {bag}"), interval, speed_band)
        return analysis, build_report_data(recording, analysis)


@contextmanager
def _named(bag):
    try:
        yield
    except ValueError as error:
        raise CommandError(f"recording {bag!r}: {error}") from None


def require_different(bags):
    """Refuse a bag that is given twice: the tables tell bags apart by their paths."""
    seen = set()
    for bag in bags:
        files = {realpath(bag)} if is_csv(bag) else set(map(realpath, bag_files(bag)))
        if files & seen:
            raise CommandError(f"recording {bag!r} is given twice")
        seen |= files


def _reporter(progress, description):
    task = progress.add_task(description)
    return lambda done, total: progress.update(task, completed=done, total=total)


def _levels(analyses):
    title = "acceleration, m/s²: band-limited; weighted by ISO 2631-1 (VDV in m/s^1.75); power absorbed by a driver, W"
    table = new_table(title, ("",))
    for name in ("RMS", "peak", "weighted", "crest", "MTVV", "VDV", "power"):
        table.add_column(name, justify="right")
    for analysis in _sections(table, analyses, "sensors"):
        for sensor, axes in analysis.sensors.items():
            for axis, n in axes.items():
                if isnan(n.rms):
                    continue
                weighted = f"{WEIGHTINGS[AXES.index(axis)]} {_told(n.rms_weighted)}"
                rest = (n.crest_factor, n.mtvv, n.vdv, *((analysis.absorbed_power[sensor],) if axis == "z" else ()))
                table.add_row(f"{sensor} {axis}", _told(n.rms), _told(n.peak), weighted, *map(_told, rest))
    return table


def _speeds(analyses):
    """By speed, of bags in which it varies."""
    table = new_table("by speed: vertical RMS, m/s², and power absorbed by a driver, W", ("speed, m/s",))
    for name in ("time, s", "engine, r/min", *(name for sensor in SENSORS for name in (sensor, "W"))):
        table.add_column(name, justify="right")
    for analysis in _sections(table, [each for each in analyses if len(each.by_speed) > 1], "by_speed"):
        for band in analysis.by_speed:
            levels = (number for sensor in SENSORS for number in (band.rms[sensor]["z"], band.absorbed_power[sensor]))
            engine = "" if isnan(band.engine_speed) else f"{band.engine_speed:.0f}"
            words = f"{band.low:g} to {band.high:g}", f"{band.measured:.1f}", engine
            table.add_row(*words, *map(_told, levels))
    return table


def _lines(analyses):
    table = new_table("RMS about lines with a known cause, m/s²", ("", "Hz", ""))
    for axis in AXES:
        table.add_column(axis, justify="right")
    for analysis in _sections(table, analyses, "lines"):
        for line in analysis.lines:
            names = (line.name, line.hertz)
            for sensor, axes in line.rms.items():
                table.add_row(*names, sensor, *map(_told, axes.values()))
                names = ("", "")
    return table


def _mounts(analyses):
    table = new_table("mounts: vertical travel (mm) and force (kN) about their means, heat, current (A)", ("",))
    for name in ("travel", "peak", "force", "peak", "heat, W", "mean", "least", "most"):
        table.add_column(name, justify="right")
    for analysis in _sections(table, analyses, "mounts"):
        for name, mount in analysis.mounts.items():
            z, current = mount.axes["z"], mount.current
            lengths, forces = (z.travel_rms, z.travel_peak), (z.force_rms, z.force_peak)
            numbers = (*(1e3 * each for each in lengths), *(1e-3 * each for each in forces), mount.power_dissipated,
                       current.mean, current.least, current.greatest)  # fmt: skip
            table.add_row(name, *(f"{each:.2f}" for each in numbers))
    return table


def _told(level):
    return "-" if isnan(level) else f"{level:.3f}"


def _sections(table, analyses, name):
    """Iterate over analyses that have something under a name; each gets a part of a table, numbered of several."""
    for number, analysis in enumerate(analyses, 1):
        if getattr(analysis, name):
            table.add_section()
            if len(analyses) > 1:
                table.add_row(f"recording {number}", style="bold")
            yield analysis


def new_table(title, words):
    table = Table(title=title, title_justify="left")
    for name in words:
        table.add_column(name)
    return table
