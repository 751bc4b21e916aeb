"""`trackvib replay --controller`: recorded accelerations into a live controller, its currents beside the recorded."""

import json
from contextlib import contextmanager

import numpy as np
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from mr_mount_controller.node_base.topics import CHASSIS_IMU, COIL_CURRENT, COIL_CURRENT_TYPE, POWERTRAIN_IMU

from ..analysis.replay_pictures import currents_picture
from ..analysis.stamps import period_of
from ..bags.copying import copy_bag
from ..bags.errors import BagError
from ..bags.files import called
from ..bags.qos import qos_record
from ..bags.raw_messages import sample_messages
from ..bags.reading import read_recording
from ..bags.writing import BagWriter
from ..console import followed
from ..nodes.controller_trial import ControllerTrial
from ..nodes.processes import closed_loop_parameters
from ..numerics.units import NANO
from .result_folder import CommandError, all_or_nothing
from .run import own_domain

REPLAYED = "/replayed/current"  # topic of the new answers


def run_replay_controller(bag, law, stock, out, console):
    """Replay into a stock controller with a law, or with None into the one that the user runs.

    `stock` is its `LoopProcesses`, made before ROS 2 was loaded.

    Leaves the recorded messages with the new answers as a bag, a summary, and a picture where there is something to
    compare, in the new folder `out`.

    Raises
    ------
    BagError, CommandError
        The bag lacks a topic, the folder cannot be made, the domain is taken, or the controller ended.
    """
    recording = read_recording(bag)
    recording.require()
    samples = len(recording.chassis.stamp)
    if REPLAYED in recording.counts:
        made_of = recording.provenance.get("replay", {}).get("bag", "the bag it was made of")
        raise BagError(f"bag {str(bag)!r} is the result of such a replay; give {made_of} instead")
    if samples < 2:
        raise BagError(f"bag {str(bag)!r} holds a single sample, at least two are needed")
    summary = {"bag": str(bag), "controller": law or "external", "samples": samples}
    title = f"{called(bag)} into {law or 'a controller'}"
    with own_domain(), all_or_nothing(out) as folder:
        replayed, interrupt = _replay_into_bag(recording, stock, law, folder, console)
        summary |= {
            "answered": len(replayed),
            **_compare(_answers(recording), replayed, recording.mounting.names, folder / "currents.png", title),
        }
        (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    if interrupt is not None:
        raise interrupt
    console.print(_words(summary), soft_wrap=True)
    console.print(f"left in {folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}", soft_wrap=True)


def _replay_into_bag(recording, stock, law, folder, console):
    """Write all recorded messages and the answers to a bag.

    Returns the answers and the KeyboardInterrupt that ended it, or None: the bag is whole all the same.
    """
    writer, replayed = BagWriter(folder / "bag"), {}
    try:
        copy_bag(recording.path, writer)
        for name, values in recording.provenance.items():
            writer.add_provenance(name, values)
        writer.add_provenance("replay", {"bag": recording.path, "controller": law or "external"})
        _replay(recording, stock, law, writer, replayed, folder, console)
    except KeyboardInterrupt as interrupt:
        return replayed, interrupt
    finally:
        writer.close()
    return replayed, None


def _replay(recording, stock, law, writer, replayed, folder, console):
    """Add the controller's currents by stamp [ns] to `replayed`, and to the bag, as they come."""
    topics, stamps = recording.topics, recording.chassis.stamp
    with (
        _controller(stock, law, round(NANO / period_of(stamps)), folder) as check,
        ControllerTrial(recording.mounting) as trial,
    ):
        if law is None:
            console.print(f"waiting for a controller that listens to {CHASSIS_IMU} or {POWERTRAIN_IMU} and answers on "
                          f"{COIL_CURRENT}", soft_wrap=True)  # fmt: skip
        trial.wait_for_controller(check)
        writer.add_topic(REPLAYED, COIL_CURRENT_TYPE, [qos_record(LOOP_WRITER_QOS)], trial.type_hash())
        samples = sample_messages(recording.path, topics[CHASSIS_IMU], topics[POWERTRAIN_IMU])
        for stamp, *imus in followed(samples, "asking the controller", console, len(stamps)):
            answer = trial.answer(stamp, *imus)
            if answer is None:
                check()
            else:
                writer.write(REPLAYED, stamp, answer.data)
                replayed[stamp] = answer.current


def _answers(recording):
    """Return the recorded currents (coils,) [A] by sample stamp [ns], the first to each."""
    currents = {}
    if recording.answers is not None:
        for stamp, current in zip(*(column.tolist() for column in recording.answers), strict=True):
            currents.setdefault(stamp, tuple(current))
    return currents


@contextmanager
def _controller(stock, law, rate, folder):
    """Run the stock controller, unless the user runs one; gives what raises `CommandError` if it has ended."""
    if law is None:
        yield lambda: None
        return
    (folder / "log").mkdir()
    given = {"controller": {"law": law, "sample_rate": rate, "wait_for_recorder": False}}
    stock.start(closed_loop_parameters(), given, folder / "log")

    def check():
        if stock.ended():
            raise CommandError(f"'controller' ended; it said:\n{stock.last_words('controller')}")

    try:
        yield check
    finally:
        stock.stop()


def _compare(recorded, replayed, coils, picture, title):
    """Return how far the currents are apart [A], where both are, and draw them; empty if they never are."""
    both = sorted(recorded.keys() & replayed.keys())
    if not both:
        return {"compared": 0}
    old, new = (np.array([currents[stamp] for stamp in both]) for currents in (recorded, replayed))
    currents_picture(np.array(both) / NANO, old, new, coils, title, picture)
    difference = new - old
    return {
        "compared": len(both),
        "largest_difference_A": float(np.abs(difference).max()),
        "rms_difference_A": float(np.sqrt(np.mean(difference**2))),
        "identical": old.tobytes() == new.tobytes(),
    }


def _words(summary):
    answered = f"{summary['answered']} of {summary['samples']} samples answered"
    if not summary["compared"]:
        return f"currents: {answered}; none recorded to compare them with"
    if summary["identical"]:
        return f"currents: {answered}; identical to the recorded ones to the last bit"
    return (
        f"currents: {answered}; against the recorded ones largest difference {summary['largest_difference_A']:.6g} A, "
        f"RMS {summary['rms_difference_A']:.6g} A"
    )
