"""`trackvib compare`: a measured recording beside a simulated one; a table on the screen, files in one new folder."""

from datetime import datetime
from pathlib import Path

from ..analysis.bag_tables import write_tables
from ..analysis.comparison.compare import compare
from ..analysis.comparison.settlings import settlings
from ..analysis.comparison.tables import write_comparison
from ..analysis.report.page import write_report
from ..analysis.report.ratio_section import ratio_section, ratio_table
from ..bags.reading import HEADER_TIME
from ..bags.sources import Sources
from ..console import Terminal, progress_on
from .analyze import measure, new_table, read, require_different
from .result_folder import CommandError, all_or_nothing


def run_compare(measured, simulated, align, speed_band, interval, settle, out, time, unit, sources):
    """Compare two recordings; see `compare_cli`.

    Raises
    ------
    BagError, CommandError
        They are one, one cannot be read or is too short, or the folder exists or cannot be written. No folder is left
        then.
    """
    console = Terminal()
    folder = out or Path("comparisons") / f"{datetime.now():%Y%m%dT%H%M%S}"
    with all_or_nothing(folder) as folder:
        require_different([measured, simulated])
        with progress_on(console) as progress:
            recordings = (
                read(measured, progress, time, unit, sources),
                read(simulated, progress, HEADER_TIME, "m/s2", Sources()),
            )
            settling = settlings(recordings, settle)
            found = [
                measure(recording, bag, progress, seconds, interval, speed_band)
                for recording, bag, (seconds, _) in zip(recordings, (measured, simulated), settling, strict=True)
            ]
            analyses, report_data_list = zip(*found, strict=True)
            try:
                comparison = compare(recordings, analyses, align, interval, speed_band)
            except ValueError as error:
                raise CommandError(f"{measured!r} and {simulated!r} cannot be compared: {error}") from None
        write_tables(analyses, folder)
        write_comparison(comparison, folder)
        write_report(list(report_data_list), folder / "report.html", [ratio_section(comparison)])
    for word, analysis, (seconds, why) in zip(("measured", "simulated"), analyses, settling, strict=True):
        counts = f"{analysis.measured:g} s count, after {seconds:g} s of settling ({why})"
        console.print(f"{word}: {analysis.bag}: {counts}", soft_wrap=True)
        for note in analysis.notes:
            console.print(f"  {note}", soft_wrap=True)
    for note in comparison.notes:
        console.print(note, soft_wrap=True)
    _print(comparison, console)
    console.print(f"written to {folder}: {', '.join(sorted(each.name for each in folder.iterdir()))}", soft_wrap=True)


def _print(comparison, console):
    found = ratio_table(comparison)
    how = {"none": "not aligned"}.get(comparison.aligned_by, f"aligned by {comparison.aligned_by}")
    title = f"simulated over measured, {how}, levels up to {comparison.band[1]:.4g} Hz"
    table = new_table(title, found.head[: found.words])
    for name in found.head[found.words :]:
        table.add_column(name, justify="right", no_wrap=True)
    for row in found.rows:
        table.add_row(*row)
    console.print(table)
