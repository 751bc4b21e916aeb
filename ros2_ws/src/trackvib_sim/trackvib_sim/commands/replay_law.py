"""`trackvib replay --law`: a recorded drive once more in process, on the same road, under another law."""

import json
from pathlib import Path

from mr_mount_controller.laws import find_law
from rich.progress import track
from rich.table import Table

from ..analysis.replay_pictures import drives_picture
from ..analysis.settling import SHORTEST_SETTLING, settling_time
from ..analysis.summary import (
    AXES,
    SENSORS,
    SHORTEST_MEASURING,
    Prepared,
    TooShort,
)
from ..analysis.vibration import band, band_limited, rms
from ..bags.copying import copy_bag
from ..bags.replaying import read_recorded_drive
from ..bags.versions import versions
from ..bags.writing import BagWriter
from ..nodes import topics
from ..nodes.rerun_bag import RerunBag
from ..nodes.simulator_parameters import prepare_again
from ..simulation.closed_loop import periods_under_law
from ..simulation.settings import NANO
from ..simulation.simulation import RunFailed
from ..vehicle.mount_audit import mount_account
from .closed_loop_run import make_folder


def perform(bag, law, out, console):
    """Drive again under a law; leaves bag, summary and picture in the new folder `out`.

    Raises
    ------
    BagError, ValueError, RunError
        The bag does not tell enough or is too short, or the folder cannot be made.
    """
    recording = read_recorded_drive(bag)
    simulation, values = prepare_again(recording)
    settle, rate = _settling(values, recording.provenance), simulation.settings.rates.control
    _prepared(recording.chassis, recording.powertrain, rate, settle)  # too short a drive is refused before anything
    chosen = find_law(law)(1.0 / rate)
    folder = make_folder(out)
    ended = _drive(bag, recording, simulation, chosen, law, folder / "bag", console)
    rerun = read_recorded_drive(folder / "bag")

    labels = (f"recorded ({_recorded_law(recording.provenance)})", f"replayed ({law})")
    last = rerun.chassis.stamp[-1]
    try:
        drives = {
            label: _prepared(_until(drive.chassis, last), _until(drive.powertrain, last), rate, settle)
            for label, drive in zip(labels, (recording, rerun), strict=True)
        }
    except TooShort as error:
        raise TooShort(f"{ended}; {error}") from None
    currents = {label: _currents(drive, last) for label, drive in zip(labels, (recording, rerun), strict=True)}
    drives_picture(drives, currents, f"{Path(bag).name} again under {law}, {last / NANO:g} s", folder / "replay.png")
    how = {"bag": str(bag), "law": law, "duration_s": last / NANO, "ended": ended}
    summary = {"replay": how, **_levels(drives, settle), "mounts_J": mount_account(simulation.state.audit)._asdict()}
    (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    console.print(_table(summary, labels))
    console.print(f"{ended}; left in {folder}: bag/, summary.json, replay.png", soft_wrap=True)


def _drive(bag, recording, simulation, chosen, law, path, console):
    """Run to the recorded end, or as far as road and vehicle go, into a bag; returns how it ended."""
    periods = int(recording.chassis.stamp[-1]) // simulation.settings.rates.period
    writer = BagWriter(path)
    ended, exchange = "driven to the recorded end", None
    try:
        constant = (topics.ROAD_PROFILE, topics.VEHICLE_DESCRIPTION)
        known = copy_bag(bag, writer, lambda topic: topic.endswith(constant))
        _describe(writer, recording.provenance, bag, law, chosen)
        rerun = RerunBag(writer, known, recording.chassis.topic.removesuffix(topics.CHASSIS_IMU), simulation)
        rerun.begin()
        loop = periods_under_law(simulation, chosen)
        for _ in track(range(periods), f"driving under {law}", console=console, transient=True):
            if not simulation.road_is_enough():
                ended = f"the recorded road ends here: {simulation.distance:.1f} m, t = {simulation.time / NANO:.3f} s"
                break
            try:
                exchange = next(loop)
            except RunFailed as failure:
                ended = f"the run failed: {failure}"
                break
            rerun.write_period(exchange)
        if exchange is None:
            raise TooShort(f"nothing to compare: {ended}")
        rerun.write_diagnostics("finished", exchange)
    finally:
        writer.close()
    return ended


def _describe(writer, provenance, bag, law, chosen):
    """Write down what made the rerun: as recorded, but for the software and the law."""
    writer.add_provenance("versions", versions())
    writer.add_provenance("replay", {"bag": bag, "law": law})
    for name, told in provenance.items():
        if "law" in told and name != "replay":
            told = {"law": law, **{parameter.name: getattr(chosen, parameter.name) for parameter in chosen.parameters}}
        if name not in ("versions", "replay"):
            writer.add_provenance(name, told)


def _settling(values, provenance):
    """How long the recorded run settled [s], on the road that its bag tells of."""
    told = next((told for told in provenance.values() if "level_until" in told and "fade" in told), None)
    if told is None:
        return SHORTEST_SETTLING
    return settling_time(values["speed"], float(told["level_until"]) + float(told["fade"]))


def _recorded_law(provenance):
    laws = [told["law"] for name, told in provenance.items() if "law" in told and name != "replay"]
    return laws[0] if laws else "law not told"


def _prepared(chassis, powertrain, rate, settle):
    """Return two `bags.replaying.Stream`s ready to be measured; raises `TooShort`."""
    time = chassis.stamp / NANO
    if time[-1] < settle + SHORTEST_MEASURING:
        raise TooShort(f"the drive is {time[-1]:g} s long, RMS values need {settle + SHORTEST_MEASURING:g} s")
    raw = dict(zip(SENSORS, (chassis.specific_force, powertrain.specific_force), strict=True))
    limited = {sensor: band_limited(values, rate) for sensor, values in raw.items()}
    return Prepared(time, raw, limited, rate, time > settle)


def _until(stream, stamp):
    """The part of a stream up to a stamp [ns]."""
    kept = stream.stamp <= stamp
    return stream._replace(stamp=stream.stamp[kept], values=stream.values[kept])


def _currents(drive, last):
    """Times [s] and demanded currents (k, 2) [A] of all answers up to a stamp [ns]."""
    kept = drive.answered <= last
    return drive.answered[kept] / NANO, drive.current[kept]


def _levels(drives, settle):
    recorded, replayed = (
        {sensor: dict(zip(AXES, rms(drive.limited[sensor][drive.settled]).tolist(), strict=True)) for sensor in SENSORS}
        for drive in drives.values()
    )
    return {
        "band_hz": list(band(next(iter(drives.values())).rate)),
        "settled_after_s": settle,
        "rms_mps2": {"recorded": recorded, "replayed": replayed},
        "change_percent": {
            sensor: {axis: 100.0 * (replayed[sensor][axis] / recorded[sensor][axis] - 1.0) for axis in AXES}
            for sensor in SENSORS
        },
    }


def _table(summary, labels):
    low, high = summary["band_hz"]
    title = f"RMS acceleration, m/s², {low:g}-{high:g} Hz, after {summary['settled_after_s']:.1f} s"
    table = Table(title=title, title_justify="left")
    table.add_column("")
    table.add_column("")
    for name in ("longitudinal x", "lateral y", "vertical z"):
        table.add_column(name, justify="right")
    for sensor in SENSORS:
        for label, levels in zip(labels, summary["rms_mps2"].values(), strict=True):
            table.add_row(sensor, label, *(f"{levels[sensor][axis]:.3f}" for axis in AXES))
        change = summary["change_percent"][sensor]
        table.add_row(sensor, "change", *(f"{change[axis]:+.1f} %" for axis in AXES), end_section=True)
    return table
