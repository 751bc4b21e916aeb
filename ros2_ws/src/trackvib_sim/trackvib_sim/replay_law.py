"""`trackvib replay --law`: a recorded drive once more in process, on the same road, under another law."""

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mr_mount_controller.laws import find_law
from rich.progress import track
from rich.table import Table

from .analysis.replay_pictures import drives_picture
from .analysis.summary import AXES, SENSORS, SHORTEST_SETTLING, TooShort, prepare, settling_time
from .analysis.vibration import band, rms
from .bags.copying import copy_bag
from .bags.replaying import read_recording
from .bags.versions import versions
from .bags.writing import BagWriter
from .closed_loop_run import make_folder
from .nodes import topics
from .nodes.rerun_bag import RerunBag
from .nodes.simulator_parameters import prepare_again
from .simulation.closed_loop import periods_under_law
from .simulation.settings import NANO
from .simulation.simulation import CHASSIS, POWERTRAIN, RunFailed
from .vehicle.mount_audit import mount_account


class Rerun(NamedTuple):
    """What came out, one row a control period."""

    stamp: np.ndarray  # (k,) ns
    values: np.ndarray  # (2, k, 6) of both Imu: specific force [m/s^2] and rate [rad/s]
    current: np.ndarray  # (k, 2) demanded, A
    ended: str  # why


def perform(bag, law, out, console):
    """Drive again under a law; leaves bag, summary and picture in the new folder `out`.

    Raises
    ------
    BagError, ValueError, RunError
        The bag does not tell enough or is too short, or the folder cannot be made.
    """
    recording = read_recording(bag)
    simulation, values = prepare_again(recording)
    settle = _settling(values, recording.provenance)
    prepare(recording, settle)  # a drive too short to be measured is refused before anything is made
    chosen = find_law(law)(simulation.settings.rates.period / NANO)
    folder = make_folder(out)
    rerun = _drive(bag, recording, simulation, chosen, law, folder / "bag", console)

    if not len(rerun.stamp):
        raise TooShort(f"nothing to compare: {rerun.ended}")
    replayed = recording._replace(
        chassis=recording.chassis._replace(stamp=rerun.stamp, values=rerun.values[CHASSIS]),
        powertrain=recording.powertrain._replace(stamp=rerun.stamp, values=rerun.values[POWERTRAIN]),
    )
    labels = (f"recorded ({_recorded_law(recording.provenance)})", f"replayed ({law})")
    stretch = _until(recording, rerun.stamp[-1])
    try:
        drives = {label: prepare(drive, settle) for label, drive in zip(labels, (stretch, replayed), strict=True)}
    except TooShort as error:
        raise TooShort(f"{rerun.ended}; {error}") from None
    currents = {labels[0]: _recorded_currents(stretch), labels[1]: rerun.current}
    title = f"{Path(bag).name} again under {law}, {rerun.stamp[-1] / NANO:g} s"
    drives_picture(drives, currents, title, folder / "replay.png")
    summary = _summary(drives, settle, bag, law, rerun, simulation)
    (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    console.print(_table(summary, labels))
    console.print(f"{rerun.ended}; left in {folder}: bag/, summary.json, replay.png", soft_wrap=True)


def _drive(bag, recording, simulation, chosen, law, path, console):
    """Run to the recorded end, or as far as road and vehicle go, and write it all down as it comes."""
    rates = simulation.settings.rates
    periods = int(recording.chassis.stamp[-1]) // rates.period
    writer = BagWriter(path)
    stamps, values, currents = [], ([], []), []
    ended = "driven to the recorded end"
    try:
        constant = (topics.ROAD_PROFILE, topics.VEHICLE_DESCRIPTION)
        known = copy_bag(bag, writer, lambda topic: topic.endswith(constant))
        _describe(writer, recording.provenance, bag, law, chosen)
        rerun = RerunBag(writer, known, recording.chassis.topic.removesuffix(topics.CHASSIS_IMU), simulation)
        rerun.begin()
        exchange, loop = None, periods_under_law(simulation, chosen)
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
            sample = simulation.sample
            for sensor in (CHASSIS, POWERTRAIN):
                values[sensor].append(np.concatenate((sample.specific_force[sensor], sample.rate[sensor])))
            stamps.append(simulation.time)
            currents.append(exchange.currents.copy())
        if exchange is not None:
            rerun.write_diagnostics("finished", exchange)
    finally:
        writer.close()
    return Rerun(np.array(stamps), np.array(values), np.array(currents), ended)


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


def _until(recording, stamp):
    """The part of a recording up to a stamp [ns]."""
    parts = {}
    for name in ("chassis", "powertrain"):
        stream = getattr(recording, name)
        kept = stream.stamp <= stamp
        parts[name] = stream._replace(stamp=stream.stamp[kept], values=stream.values[kept])
    return recording._replace(**parts)


def _recorded_currents(recording):
    """The last answer to each sample (k, 2), NaN where there is none."""
    stamps = recording.chassis.stamp
    currents = np.full((len(stamps), 2), np.nan)
    place = np.searchsorted(stamps, recording.answered)
    there = place < len(stamps)
    there[there] = stamps[place[there]] == recording.answered[there]
    currents[place[there]] = recording.current[there]
    return currents


def _summary(drives, settle, bag, law, rerun, simulation):
    levels = [
        {sensor: dict(zip(AXES, rms(drive.limited[sensor][drive.settled]).tolist(), strict=True)) for sensor in SENSORS}
        for drive in drives.values()
    ]
    recorded, replayed = levels
    return {
        "replay": {"bag": str(bag), "law": law, "duration_s": rerun.stamp[-1] / NANO, "ended": rerun.ended},
        "band_hz": list(band(next(iter(drives.values())).rate)),
        "settled_after_s": settle,
        "rms_mps2": {"recorded": recorded, "replayed": replayed},
        "change_percent": {
            sensor: {axis: 100.0 * (replayed[sensor][axis] / recorded[sensor][axis] - 1.0) for axis in AXES}
            for sensor in SENSORS
        },
        "mounts_J": mount_account(simulation.state.audit)._asdict(),
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
