"""`trackvib replay --law`: a recorded drive once more in process, on the same road, under another law."""

import json

import numpy as np
from mr_mount_controller.laws import find_law
from mr_mount_controller.laws.running import make_law
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.plain_text import readable, shortened
from rich.table import Table

from ..analysis.analyse import analyse
from ..analysis.numbers import AXES, SENSORS
from ..analysis.picture_data import prepare
from ..analysis.replay_pictures import drives_picture
from ..analysis.segments import TooShort
from ..analysis.stamps import start_of
from ..analysis.summary import summarise
from ..bags.copying import copy_bag
from ..bags.files import called
from ..bags.provenance import PARAMETERS_OF, parameters_with, recorded_law, write_parameters, write_versions
from ..bags.reading import read_recording
from ..bags.writing import BagWriter
from ..console import followed
from ..nodes.rerun_bag import RerunBag
from ..nodes.simulator_parameters import prepare_again
from ..numerics.units import NANO
from ..simulation.closed_loop import periods_under_law
from ..simulation.simulation import RunFailed
from ..vehicle.mount_energy import mount_energy_account
from .result_folder import all_or_nothing


def run_replay_law(bag, law, out, console):
    """Drive again under a law; leaves bag, summary and picture in the new folder `out`.

    Raises
    ------
    BagError, ValueError, CommandError
        The bag does not tell enough or is too short, or the folder cannot be made.
    """
    recording = read_recording(bag)
    recording.require("mounts", "road", "vehicle")
    analyse(recording)  # too short a drive is refused before anything is done
    simulation, _ = prepare_again(recording)
    kind = find_law(law)
    values, changes = recorded_law(recording, law, kind)
    chosen = make_law(kind, 1.0 / simulation.settings.rates.control, values)
    with all_or_nothing(out) as folder:
        ended = _drive(recording, simulation, (chosen, changes), law, folder / "bag", console)
        labels, summary = _compare(recording, read_recording(folder / "bag"), law, ended, folder)
        summary["mounts_J"] = mount_energy_account(simulation.state.mount_energy)._asdict()
        (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    console.print(_table(summary, labels))
    console.print(f"{ended}; written to {folder}: bag/, summary.json, replay.png", soft_wrap=True)


def _compare(recording, rerun, law, ended, folder):
    """Draw both drives over the same instants; returns what they are called, and their levels."""
    begin, last = start_of(recording), int(rerun.chassis.stamp[-1])
    recorded_law = parameters_with(recording.provenance, "law")[1].get("law", "law not recorded")
    labels = (f"recorded ({shortened(readable(recorded_law))})", f"replayed ({law})")
    both = _between(recording, begin, last, rerun), _between(rerun, begin, last, recording)
    drives = dict(zip(labels, both, strict=True))
    try:
        analyses = [analyse(drive) for drive in drives.values()]
    except TooShort as error:
        raise TooShort(f"{ended}; {error}") from None
    drives_picture(
        {label: prepare(drive, analyses[0].settle) for label, drive in drives.items()},
        {label: _currents(drive, begin) for label, drive in drives.items()},
        f"{called(recording.path)} again under {law}, {last / NANO:g} s",
        folder / "replay.png",
    )
    how = {"bag": str(recording.path), "law": law, "duration_s": last / NANO, "ended": ended}
    return labels, {"replay": how, **_levels(*map(summarise, analyses))}


def _drive(recording, simulation, chosen_and_changes, law, path, console):
    """Run to the recorded end, or as far as road and vehicle go, into a bag; returns how it ended."""
    chosen, changes = chosen_and_changes
    periods = int(recording.chassis.stamp[-1]) // simulation.settings.rates.period
    writer = BagWriter(path)
    ended, lockstep = "ran to the end of the recording", None
    try:
        constant = (
            topics.ROAD_PROFILE,
            topics.VEHICLE_DESCRIPTION,
            topics.MOUNT_DESCRIPTION,
            topics.DRIVE_DESCRIPTION,
            topics.DRIVE_COMMAND,
            *((topics.LAW_PARAMETERS,) if changes else ()),
        )
        controller, _ = parameters_with(recording.provenance, "law")
        other = ("versions.yaml", f"parameters{controller}.yaml")
        known = copy_bag(recording.path, writer, lambda topic: topic.endswith(constant), lambda name: name not in other)
        _describe(writer, recording, controller, law, chosen)
        space = recording.topics[topics.CHASSIS_IMU].removesuffix(topics.CHASSIS_IMU)
        rerun = RerunBag(writer, known, space, simulation)
        rerun.begin()
        loop = periods_under_law(simulation, chosen, changes=changes)
        for _ in followed(range(periods), f"driving under {law}", console):
            if not simulation.road_is_enough():
                ended = f"the recorded road ends here: {simulation.distance:.1f} m, t = {simulation.time / NANO:.3f} s"
                break
            try:
                lockstep, _ = next(loop)
            except RunFailed as failure:
                ended = f"the run failed: {failure}"
                break
            rerun.write_period(lockstep)
        if lockstep is None:
            raise TooShort(f"nothing to compare: {ended}")
        rerun.write_diagnostics("finished", lockstep)
    finally:
        writer.close()
    return ended


def _describe(writer, recording, controller, law, chosen):
    """Write down what made the rerun: as recorded, but for the software and the law of a node by its full name."""
    write_versions(writer)
    writer.add_provenance("replay", {"bag": recording.path, "law": law})
    if controller:
        own = {parameter.name: getattr(chosen, parameter.name) for parameter in chosen.parameters}
        write_parameters(writer, controller, {"law": law, **own})
    replaced = ("versions", "replay", f"{PARAMETERS_OF}{controller}")
    for name, values in recording.provenance.items():
        if name not in replaced:
            writer.add_provenance(name, values)


def _between(recording, begin, last, other):
    """The part of a recording after one stamp [ns] and up to another, of the sensors the samples that `other` has, too.

    So levels are compared over the same instants: a bag may begin in the middle of a run or lack samples, a rerun
    begins at the start, lacks none, and may end early.
    """

    def cut_out(columns, others=None):
        if columns is None:
            return None
        kept = (columns[0] > begin) & (columns[0] <= last)
        if others is not None:
            kept &= np.isin(columns[0], others.stamp)
        parts = (None if column is None else column[kept] for column in columns)
        return type(columns)(*parts) if kept.any() else None

    cut = {sensor: cut_out(getattr(recording, sensor), getattr(other, sensor)) for sensor in SENSORS}
    cut |= {part: cut_out(getattr(recording, part)) for part in ("mounts", "answers", "odometry", "drive")}
    further = {name: cut_out(sensor) for name, sensor in recording.sensors.items()}
    cut["sensors"] = {name: sensor for name, sensor in further.items() if sensor is not None}
    # when the whole run ended says nothing about a part of it
    diagnostics = {key: text for key, text in recording.diagnostics.items() if key != "time"}
    return recording._replace(diagnostics=diagnostics, **cut)


def _currents(recording, begin):
    """Times [s] from a stamp [ns] on and demanded currents (k, coils) [A] of all answers."""
    if recording.answers is None:
        return np.empty(0), np.empty((0, recording.mounting.coils))
    return (recording.answers.sample_stamp - begin) / NANO, recording.answers.current


def _levels(recorded, replayed):
    rms = {"recorded": recorded["rms_mps2"], "replayed": replayed["rms_mps2"]}
    return {
        **{name: recorded[name] for name in ("band_hz", "settled_after_s")},
        "rms_mps2": rms,
        "change_percent": {
            sensor: {
                axis: 100.0 * (rms["replayed"][sensor][axis] / rms["recorded"][sensor][axis] - 1.0) for axis in AXES
            }
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
