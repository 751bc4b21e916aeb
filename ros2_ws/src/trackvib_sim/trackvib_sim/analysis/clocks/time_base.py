"""Both sensors on one time base: stamps mended, samples that are none left out, both at the same instants."""

import numpy as np
from mr_mount_controller.node_base import topics

from ...numerics.units import NANO
from ..measured import sound_samples
from ..numbers import SENSORS
from ..stamps import period_of
from .common_band import on_common_band
from .mending import NoClock, is_even, mend
from .notes import clock_notes
from .resampling import resampled
from .wander import at_even_instants, edges_of

SLIP = 0.05  # periods, by which one sensor may get ahead of the other without being resampled
PARTS = 50  # of a recording, in which stamps are compared with the recorder's times
SURE = 6.0  # times its scatter, above which a drift against these counts
LEAST_DRIFT = 0.2  # periods, likewise
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
        if recording.origins and name not in recording.origins:
            found[name] = inertial
            notes.append(f"no {name} in the recording: its numbers, and those that need both sensors, are missing")
            continue
        found[name], clock, words = _mended(inertial, end)
        notes += words
        if clock is not None:
            clocks[end] = clock
    chassis, powertrain = (found.pop(sensor) for sensor in SENSORS)
    measured = [bool(np.isfinite(each.specific_force[0]).all()) for each in (chassis, powertrain)]
    if not any(measured):
        raise NoClock(f"neither {' nor '.join(_ENDS.values())} measured an acceleration: {'; '.join(notes)}")
    if all(measured):
        for step in (_by_one_clock, _at_the_same_instants):
            powertrain, words = step(chassis, powertrain)
            notes += words
    elif measured[0]:
        powertrain = _nothing_beside(chassis)
    else:
        chassis = _nothing_beside(powertrain)
    pair, own, words = on_common_band({"chassis": chassis, "powertrain": powertrain}, ALIKE)
    notes += words
    return recording._replace(**pair, sensors=found, own=own, notes=tuple(notes), clocks=clocks)


def _mended(inertial, end):
    """Return an `Inertial` with even stamps and samples that are numbers, its `Clock` if that took anything, notes."""
    sound, denied = sound_samples(inertial)
    found, clock = inertial, None
    if not is_even(inertial.stamp):
        try:
            mended = mend(inertial.stamp, inertial.logged, inertial.specific_force, end)
        except NoClock as error:
            raise NoClock(f"{error}{_way_out(inertial)}") from None
        clock = mended.clock
        if clock is not None:
            found, sound = inertial.at(mended.order)._replace(stamp=mended.stamp), sound[mended.order]
    notes = [] if clock is None else clock_notes(end, clock)
    if not sound.any():
        why = "its covariance says so" if denied else "no sample is finite"
        found = found._replace(specific_force=np.broadcast_to(np.nan, found.specific_force.shape))
        notes.append(f"{end}: acceleration was not measured, {why}")
    elif not sound.all():
        notes.append(
            f"{end}: samples that are not finite: {len(sound) - sound.sum()}; each splits the recording like a gap"
        )
        found = found.at(sound)
    found, words = at_even_instants(found, end)
    return found, clock, notes + words


def _nothing_beside(inertial):
    """Return what a sensor that measured nothing has at the instants of the other: it has none of its own to keep."""
    return inertial._replace(specific_force=np.broadcast_to(np.nan, inertial.specific_force.shape))


def _way_out(inertial):
    """Offer the times at which messages were recorded, where these go on."""
    goes_on = inertial.logged is not None and period_of(inertial.logged) > 0.0
    return "; `--time log` uses the times at which messages were recorded" if goes_on else ""


def _by_one_clock(chassis, powertrain):
    """Return the powertrain with the chassis's clock, where the recorder's shows that both differ, and a note.

    Two clocks that were never set alike stamp times that do not overlap; two that run at different speeds slip.
    """
    if chassis.logged is None or powertrain.logged is None:
        return powertrain, []
    time, ahead = _ahead_of_recorder(chassis)
    other_time, other_ahead = _ahead_of_recorder(powertrain)
    overlap = min(time[-1], other_time[-1]) - max(time[0], other_time[0])
    if not overlap > 0.0:
        return powertrain, []
    at = np.linspace(max(time[0], other_time[0]), min(time[-1], other_time[-1]), PARTS)
    between = np.interp(at, other_time, other_ahead) - np.interp(at, time, ahead)
    drift, middle = np.polyfit(at - at[0], between, 1)
    scatter = float(np.std(between - middle - drift * (at - at[0])))
    total, period = drift * overlap, period_of(chassis.stamp)
    notes, shift = [], np.zeros(PARTS)
    if abs(total) > max(SURE * scatter, LEAST_DRIFT * period):
        shift = drift * (at - at[0])
        notes.append(
            f"powertrain/imu: by the times at which messages were recorded its clock runs {1e6 * drift:+.4g} ppm "
            f"against that of chassis/imu ({total / NANO:+.3g} s in all): corrected"
        )
    if powertrain.stamp[0] > chassis.stamp[-1] or powertrain.stamp[-1] < chassis.stamp[0]:
        shift = shift + middle
        notes.append(
            f"powertrain/imu: its stamps are {middle / NANO:+.6g} s from those of chassis/imu, recorded at the same "
            "time: corrected"
        )
    if not notes:
        return powertrain, []
    back = np.interp((powertrain.stamp - powertrain.stamp[0]).astype(float),
                     np.interp(at, *_stamps_at(powertrain)), shift)  # fmt: skip
    return powertrain._replace(stamp=powertrain.stamp - np.round(back).astype(np.int64)), notes


def _ahead_of_recorder(inertial):
    """Return times of the recorder (p,) and by how much the stamps are ahead of it then, medians of parts, ns."""
    count = min(PARTS, len(inertial.stamp))
    edges = np.linspace(0, len(inertial.stamp), count + 1).astype(int)
    parts = [slice(*each) for each in zip(edges[:-1], edges[1:], strict=True)]
    ahead = np.array([np.median(inertial.stamp[part] - inertial.logged[part]) for part in parts])
    return np.array([np.median(inertial.logged[part]) for part in parts]), ahead


def _stamps_at(inertial):
    """Return times of the recorder (p,), and the stamps from the first on [ns] then."""
    time, ahead = _ahead_of_recorder(inertial)
    return time, time + ahead - float(inertial.stamp[0])


def _at_the_same_instants(chassis, powertrain):
    """Return the powertrain at the instants of the chassis, if its samples slip against those, and a note."""
    if np.array_equal(chassis.stamp, powertrain.stamp):  # as of a simulator
        return powertrain, []
    period, other = period_of(chassis.stamp), period_of(powertrain.stamp)
    if abs(other / period - 1.0) > ALIKE:
        return powertrain, []
    stamps, slips = [], []
    edges = edges_of(powertrain.stamp)
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
        places = np.concatenate([place for *_, place in stamps]) if stamps else np.zeros(1)
        apart = float(np.median(np.abs(places - np.round(places))))
        note = (
            f"powertrain/imu is sampled {1e-6 * apart * other:.3g} ms from chassis/imu: paired with the nearest sample"
        )
        return powertrain, [note] if apart > SLIP else []
    force = [resampled(powertrain.specific_force[b:e], place, other / period) for _, b, e, place in stamps]
    stamp = np.concatenate([at for at, *_ in stamps])
    drift = 1e6 * (period / other - 1.0)
    note = (
        f"powertrain/imu samples {abs(drift):.3g} ppm {'faster' if drift > 0 else 'slower'} than chassis/imu (up to "
        f"{max(slips):.3g} samples): resampled, band-limited, to the instants of chassis/imu"
    )
    return type(powertrain)(stamp, np.concatenate(force), None), [note]
