"""What a run of the closed loop leaves beside its bag: summary and picture, and what is printed."""

import json
from dataclasses import asdict

from rich.table import Table

from ..analysis.analyse import analyse
from ..analysis.completeness import missing
from ..analysis.numbers import AXES
from ..analysis.picture_data import prepare
from ..analysis.plots import run_picture
from ..analysis.settling import SHORTEST_SETTLING
from ..analysis.summary import summarise
from ..bags.reading import read_recording
from ..console import Terminal
from ..vehicle.mount_energy import MountEnergy
from .result_folder import whole_or_none


def evaluate(choices, folder, console):
    """Leave summary and picture of a run, settled as `trackvib analyze` has it; returns in words what the bag lacks."""
    # of a run that was reset the last epoch; its bag has the highest number
    bag = max(folder.glob("bag*"), key=lambda path: (len(path.name), path.name), default=folder / "bag")
    recording = read_recording(bag)
    analysis = analyse(recording)
    summary = {"run": asdict(choices), **summarise(analysis)}
    files = [folder / name for name in ("summary.json", "run.png", "summary.txt")]
    with whole_or_none(*files) as (numbers, picture, text):
        numbers.write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        run_picture(prepare(recording, analysis.settle), analysis.lines, choices.title, picture)
        with text.open("w", encoding="utf-8") as file:
            _print_summary(Terminal(file=file, width=100), summary, folder)
    _print_summary(console, summary, folder)
    return missing(recording)


def _print_summary(console, summary, folder):
    low, high = summary["band_hz"]
    settled = summary["settled_after_s"]
    if settled > SHORTEST_SETTLING:
        console.print(
            f"the first {settled:.1f} s do not count: not all of the vehicle was on the road's full roughness"
        )
    title = f"RMS acceleration, {low:g}-{high:g} Hz, after {settled:.1f} s"
    table = Table(title=title, title_justify="left")
    table.add_column("m/s²")
    for name in ("longitudinal x", "lateral y", "vertical z"):
        table.add_column(name, justify="right")
    for sensor, rms in summary["rms_mps2"].items():
        table.add_row(sensor, *(f"{rms[axis]:.3f}" for axis in AXES))
    console.print(table)
    loop, mounts = summary["loop"], MountEnergy(**summary["mounts_J"])
    unanswered = loop["samples"] if loop["unanswered"] is None else loop["unanswered"]  # None: not one answer came
    for line in (
        *_drive(summary["drive_N"], summary["drive_W"]),
        f"mounts: {mounts.work:.1f} J of work = {mounts.dissipated:.1f} dissipated {mounts.stored:+.1f} stored "
        f"{mounts.exchanged:+.1f} lost to the field by switching; residual {100.0 * mounts.error:.3f} %",
        f"loop: {loop['samples']} samples; lost {loop['lost_chassis']} chassis, {loop['lost_powertrain']} powertrain; "
        f"unanswered {unanswered}; late {loop['late']}; rejected "
        f"{int(loop['early']) + int(loop['duplicate']) + int(loop['not_finite'])}; saturated {loop['saturated']}",
        f"pace: {float(loop['real_time_factor']):.2f} x real time; of each period physics "
        f"{loop['physics_us_per_period']} us, publishing {loop['publishing_us_per_period']} us, waiting for the answer "
        f"{loop['answer_us_per_period']} us, for road or recorder {loop['holding_us_per_period']} us",
        f"written to {folder}: bag/, summary.json, summary.txt, run.png, log/",
    ):
        console.print(line, soft_wrap=True)


def _drive(force, power):
    """A line on the running resistance, none where the vehicle stands."""
    words = "at the sprockets, mean of the run"
    return [] if force is None else [f"drive: {force / 1e3:.1f} kN, {power / 1e3:.1f} kW {words}"]
