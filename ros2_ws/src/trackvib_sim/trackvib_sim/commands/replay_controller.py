"""`trackvib replay --controller`: recorded accelerations into a live controller, its currents beside the recorded."""

import json
from contextlib import ExitStack, contextmanager

import numpy as np
from mr_mount_controller.laws import find_law
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from mr_mount_controller.node_base.topics import CHASSIS_IMU, COIL_CURRENT, COIL_CURRENT_TYPE, POWERTRAIN_IMU

from ..analysis.replay_pictures import currents_picture
from ..bags.copying import copy_bag
from ..bags.errors import BagError
from ..bags.files import called
from ..bags.playing import OpenBag
from ..bags.provenance import recorded_law
from ..bags.qos import qos_record
from ..bags.reading import read_recording
from ..bags.samples import paired_samples
from ..bags.writing import BagWriter
from ..console import followed
from ..nodes.controller_trial import ControllerTrial
from ..nodes.loop_arguments import CONTROLLER, closed_loop_parameters
from ..nodes.node_parameters import NodeParameters
from ..numerics.units import NANO
from .own_domain import own_domain
from .result_folder import CommandError, all_or_nothing

_GAP = 2.5  # times the median step
REPLAYED = "/replayed/current"  # topic of the new answers


def run_replay_controller(bag, law, stock, out, lookout, console):
    """Replay into a stock controller with a law, or with None into the one that the user runs.

    `stock` is its `LoopProcesses` and `lookout` a `Lookout`, both made before ROS 2 was started.

    Leaves the recorded messages with the new answers as a bag, a summary, and a picture where there is something to
    compare, in the new folder `out`.

    Raises
    ------
    BagError, CommandError
        The bag lacks a topic, the folder cannot be made, the domain is taken, or the controller ended.
    """
    recording = read_recording(bag)
    if REPLAYED in recording.counts:
        made_of = recording.provenance.get("replay", {}).get("bag", "the bag it was made from")
        raise BagError(f"bag {str(bag)!r} is the result of a replay into a controller; give {made_of} instead")
    summary = {"bag": str(bag), "controller": law or "external", "samples": len(recording.chassis.stamp)}
    title = f"{called(bag)} into {law or 'a controller'}"
    with own_domain(lookout), all_or_nothing(out) as folder:
        replayed, interrupt = _replay_into_bag(recording, stock, law, folder, console)
        summary |= {
            "answered": len(replayed),
            **_compare(_answers(recording), replayed, recording.mounting.names, folder / "currents.png", title),
        }
        (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    left = f"{folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}"
    if interrupt is not None:
        interrupt.args = (f"kept in {left}",)
        raise interrupt
    console.print(_words(summary), soft_wrap=True)
    console.print(f"written to {left}", soft_wrap=True)


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
    topics = recording.topics[CHASSIS_IMU], recording.topics[POWERTRAIN_IMU]
    with ExitStack() as stack:
        samples = paired_samples(
            stack.enter_context(OpenBag(recording.path, topics.__contains__, whole=False)), *topics
        )
        _tell_pairing(samples, len(recording.chassis.stamp), topics, console)
        values, changes = recorded_law(recording, law, find_law(law)) if law else ({}, ())
        check, why = stack.enter_context(_controller(stock, law, values, _rate(samples.stamp), folder))
        trial = stack.enter_context(ControllerTrial(recording.mounting))
        if law is None:
            console.print(f"waiting for a controller that subscribes to {CHASSIS_IMU} or {POWERTRAIN_IMU} and "
            "answers on "
                          f"{COIL_CURRENT}", soft_wrap=True)  # fmt: skip
        trial.wait_for_controller(check)
        writer.add_topic(REPLAYED, COIL_CURRENT_TYPE, [qos_record(LOOP_WRITER_QOS)], trial.type_hash())
        for stamp, *imus in followed(samples.messages, "asking the controller", console, len(samples.stamp)):
            while changes and changes[0][0] < stamp:
                trial.change(changes[0][1])
                changes = changes[1:]
            answer = trial.answer(stamp, *imus)
            if answer is None:
                check()
            else:
                writer.write(REPLAYED, stamp, answer.data)
                replayed[stamp] = answer.current
        if not replayed:
            counted = ", ".join(f"{count} {name}" for name, count in trial.counts.items() if count)
            raise CommandError(
                f"the controller answered none of {len(samples.stamp)} samples; answers: {counted or 'none at all'}. "
                f"sample_stamp of an answer must be the stamp of its Imu message{why()}"
            )


def _tell_pairing(samples, recorded, topics, console):
    """Say which samples the controller gets, where these are not all as they were recorded."""
    chassis, powertrain = topics
    if len(samples.stamp) < 2:
        raise CommandError(
            f"{len(samples.stamp)} of {recorded} samples of {chassis} have one of {powertrain} within half a period, "
            "at least two are needed"
        )
    if len(samples.stamp) < recorded or samples.apart.any():
        console.print(
            f"{len(samples.stamp)} of {recorded} samples of {chassis} have a stamp of their own and one of {powertrain}"
            f" within half a period, {np.abs(samples.apart).max() / 1e6:.3g} ms apart at most; the controller gets "
            "both with the stamp of the former",
            soft_wrap=True,
        )


def _rate(stamps):
    """Return the rate of increasing stamps [ns] in Hz, gaps aside; steps that alternate, of whole ms say, are none."""
    steps = np.diff(stamps)
    return float(NANO / steps[steps <= _GAP * np.median(steps)].mean())


def _answers(recording):
    """Return the recorded currents (coils,) [A] by sample stamp [ns], the first to each."""
    currents = {}
    if recording.answers is not None:
        for stamp, current in zip(*(column.tolist() for column in recording.answers), strict=True):
            currents.setdefault(stamp, tuple(current))
    return currents


@contextmanager
def _controller(stock, law, values, rate, folder):
    """Run the stock controller unless the user runs one; gives a check, which raises if it has ended, and why."""
    if law is None:
        yield lambda: None, lambda: ""
        return
    (folder / "log").mkdir()
    parameters = NodeParameters([CONTROLLER])
    parameters.read(closed_loop_parameters())
    parameters.give(CONTROLLER, law=law, **values, sample_rate=rate, wait_for_recorder=False)
    stock.start(parameters, folder / "log")

    def check():
        if stock.ended():
            raise CommandError(f"'controller' ended{stock.why('controller')}")

    try:
        yield check, lambda: stock.why("controller")
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
