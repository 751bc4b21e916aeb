"""Both sensors on one time base: mended stamps, samples that are none taken out, the powertrain at the chassis's instants."""

import numpy as np
from mr_mount_controller.node_base import topics

from ..numbers import SENSORS
from ..stamps import period_of, timing
from .mending import NoClock, is_even, mend
from .resampling import resampled

SLIP = 0.05  # periods, by which one sensor may get ahead of the other without being resampled
ALIKE = 0.1  # relative difference of two rates up to which one sensor is resampled to that of the other
_ENDS = dict(zip(SENSORS, (topics.CHASSIS_IMU, topics.POWERTRAIN_IMU), strict=True))


def on_one_time_base(recording):
    """Return a `bags.recording.Recording` with sensors on one time base; one that is already stays as it is.

    Its `clocks` say of each sensor with uneven stamps how they were, its `notes` what was done.

    Raises
    ------
    NoClock
        Stamps cannot be a time base; the message says why and what may help.
    """
    if recording.clocks is not None:
        return recording
    clocks, notes = {}, list(recording.notes)
    found = {}
    for name, inertial in {**{each: getattr(recording, each) for each in SENSORS}, **recording.sensors}.items():
        end = _ENDS.get(name, topics.imu_topic(name))
        inertial, clock = _mended(inertial, end)
        if clock is not None:
            clocks[end] = clock
            notes += _notes_on(end, clock)
        found[name] = inertial
    chassis, powertrain = (found.pop(sensor) for sensor in SENSORS)
    powertrain, slip = _beside(chassis, powertrain)
    notes += slip
    return recording._replace(
        chassis=chassis, powertrain=powertrain, sensors=found, notes=tuple(notes), clocks=clocks
    )


def _mended(inertial, end):
    """Return an `Inertial` with even stamps, and its `Clock` if that took anything."""
    if is_even(inertial.stamp):
        return inertial, None
    try:
        mended = mend(inertial.stamp, inertial.logged, inertial.specific_force, end)
    except NoClock as error:
        raise NoClock(f"{error}{_way_out(inertial)}") from None
    if mended.clock is None:
        return inertial, None
    columns = (None if column is None else np.array(column)[mended.order] for column in inertial[1:])
    return type(inertial)(mended.stamp, *columns), mended.clock


def _way_out(inertial):
    """Offer the times at which messages were recorded, where these go on."""
    goes_on = inertial.logged is not None and period_of(inertial.logged) > 0.0
    return "; `--time log` takes the times at which messages were recorded" if goes_on else ""


def _beside(chassis, powertrain):
    """Return the powertrain at the instants of the chassis, if its samples slip against those, and a note."""
    period, other = period_of(chassis.stamp), period_of(powertrain.stamp)
    if abs(other / period - 1.0) > ALIKE:
        return powertrain, []
    stamps, values, slips = [], [], []
    edges = _edges(powertrain.stamp)
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        own = powertrain.stamp[begin:end]
        first, last = np.searchsorted(chassis.stamp, (own[0], own[-1] + 1))
        if last - first < 2 or end - begin < 2:
            continue
        at = chassis.stamp[first:last]
        origin = own[0]
        place = np.interp((at - origin).astype(float), (own - origin).astype(float), np.arange(end - begin))
        sound = np.concatenate([[0], np.cumsum(np.round(np.diff(at) / period))])
        slips.append(np.ptp(place - sound))
        stamps.append((at, begin, end, place))
    if not slips or max(slips) <= SLIP:
        return powertrain, []
    force = [resampled(powertrain.specific_force[b:e], place, other / period) for _, b, e, place in stamps]
    stamp = np.concatenate([at for at, *_ in stamps])
    drift = 1e6 * (period / other - 1.0)
    note = (
        f"powertrain/imu samples {abs(drift):.3g} ppm {'faster' if drift > 0 else 'slower'} than chassis/imu (up to "
        f"{max(slips):.3g} samples): resampled, band-limited, to the instants of chassis/imu"
    )
    return type(powertrain)(stamp, np.concatenate(force), None), [note]


def _edges(stamp):
    """Return first indices of the stretches of even stamps, and their number."""
    return [0, *timing(stamp, 0)[1].tolist(), len(stamp)]


def _notes_on(end, clock):
    """Say in sentences what was found of a sensor's clock and done about it."""
    period = 1.0 / clock.rate
    notes = [
        f"{end}: stamps are not even ({clock.steps}); samples are taken to be so, {clock.rate:.6g} Hz by a robust line "
        f"through the stamps, which are {1e3 * clock.jitter:.3g} ms RMS and {1e3 * clock.correction:.3g} ms at most "
        f"off it, {clock.correction / period:.2g} periods"
    ]
    if clock.counted_by_log:
        notes.append(f"{end}: samples are counted by the times at which they were recorded, which are steadier")
    for count, text in (
        (clock.lost, "samples are missing between others"),
        (clock.repeated, "stamps are those of the sample before"),
        (clock.disordered, "samples were put in the order of their stamps"),
        (clock.copies, "messages are in the bag twice, one of each left out"),
        (clock.left_out, "samples stand apart or next to lost ones, left out"),
    ):
        if count:
            notes.append(f"{end}: {count} {text}")
    for step, witnessed in clock.settings:
        what = "taken back, for the recorder's clock went on" if witnessed else "split there"
        notes.append(f"{end}: the clock was set {'ahead' if step > 0 else 'back'} by {abs(step):.6g} s: {what}")
    return notes
