"""How points are measured: sensors through their analogue low-pass, sampled once a control period; probes as they are.

The low-pass is a Butterworth filter, discretised at the physics rate by the bilinear transform with its corner kept in
place. Where it starts, it has been at rest under what it meets first.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined, kernel
from ..numerics.spatial import load3, rotate_back
from ..rui.sweeps.kinematics import MotionOffset, body_axes, motion_vector, point_place
from ..rui.sweeps.response import point_specific_force

ORDER = 8  # of the low-pass
BY_DEFAULT = 0.4  # bandwidth over a sensor's own sampling rate: 16 dB are gone at half of it, 28 at 0.6
WIDEST = 0.45  # bandwidth over the physics rate, beyond which nothing is left to be filtered
_SECTIONS = ORDER // 2
_CHANNELS = 6  # specific force and angular velocity


class Points(NamedTuple):
    """Sensors and probes, in the axes of their bodies, and the memory of the sensors' filters."""

    body: np.ndarray  # (m,) row in the tree
    place: np.ndarray  # (m, 3) m
    turn: np.ndarray  # (m, 9) from the sensors' axes into those of their bodies
    filter: np.ndarray  # (m, sections, 5) b0 b1 b2 a1 a2
    memory: np.ndarray  # (m, sections, 2, 6)
    values: np.ndarray  # (m, 6) what is being filtered
    started: np.ndarray  # (1,) whether the memory has been filled
    probe_body: np.ndarray  # (p,) row in the tree
    probe_place: np.ndarray  # (p, 3) m


def points_of(sensors, probes, rows, rates):
    """Return the `Points` of `vehicle.sensors.Sensor`s and `simulation.Probe`s.

    `rows` is the bodies' rows in the tree by name, `rates` the `settings.Rates`.
    """
    m = len(sensors)
    return Points(
        body=np.array([rows[sensor.body] for sensor in sensors], dtype=np.int64),
        place=np.array([sensor.place for sensor in sensors], dtype=float).reshape(m, 3),
        turn=np.array([sensor.turn.ravel() for sensor in sensors]).reshape(m, 9),
        filter=np.array([low_pass(bandwidth(sensor, rates), rates.physics) for sensor in sensors]).reshape(
            m, _SECTIONS, 5
        ),
        memory=np.zeros((m, _SECTIONS, 2, _CHANNELS)),
        values=np.zeros((m, _CHANNELS)),
        started=np.zeros(1, dtype=np.bool_),
        probe_body=np.array([rows[probe.body] for probe in probes], dtype=np.int64),
        probe_place=np.array([probe.place for probe in probes], dtype=float).reshape(len(probes), 3),
    )


def bandwidth(sensor, rates):
    """Return the bandwidth [Hz] of a sensor's low-pass (-3 dB): its own, or `BY_DEFAULT` of its sampling rate."""
    return sensor.bandwidth or BY_DEFAULT * rates.control / sensor.divisor


def low_pass(corner, rate):
    """Return the sections (sections, 5) of a low-pass with a corner [Hz], at a physics rate [Hz], each of gain 1 at 0.

    Beyond `WIDEST` they let everything pass. `scipy.signal` has the same, but loads longer than a whole vehicle.
    """
    if corner > WIDEST * rate:
        return np.tile((1.0, 0.0, 0.0, 0.0, 0.0), (_SECTIONS, 1))
    # poles on a circle in the left half of the plane of s, from there into the unit circle; all zeros go to -1
    poles = -4.0 * np.tan(np.pi * corner / rate) * np.exp(0.5j * np.pi * np.arange(1, ORDER, 2) / ORDER)
    poles = (4.0 + poles) / (4.0 - poles)
    a = np.column_stack((-2.0 * poles.real, poles.real**2 + poles.imag**2))
    return np.hstack((np.outer(0.25 * (1.0 + a.sum(axis=1)), (1.0, 2.0, 1.0)), a))


@inlined
def measure(work, points, sample, step):
    """Take one physics step into a sample: of sensors what their filters give, of probes what is there."""
    for i in range(points.body.size):
        body = points.body[i]
        place = point_place(work.motion, body, load3(points.place, i))
        force = body_axes(work.motion, body, point_specific_force(work.motion, work.response, body, place))
        rate = body_axes(work.motion, body, motion_vector(work.motion, MotionOffset.ANGULAR_VELOCITY, body))
        turn = points.turn[i]
        axes = (turn[0], turn[1], turn[2], turn[3], turn[4], turn[5], turn[6], turn[7], turn[8])
        force, rate = rotate_back(axes, force), rotate_back(axes, rate)
        for k in range(3):
            points.values[i, k], points.values[i, 3 + k] = force[k], rate[k]
        if not points.started[0]:
            _rest(points.filter[i], points.memory[i], points.values[i])
        _filter(points.filter[i], points.memory[i], points.values[i])
        for k in range(3):
            sample.specific_force[i, k], sample.angular_velocity[i, k] = points.values[i, k], points.values[i, 3 + k]
    points.started[0] = True
    for i in range(points.probe_body.size):
        body = points.probe_body[i]
        place = point_place(work.motion, body, load3(points.probe_place, i))
        force = body_axes(work.motion, body, point_specific_force(work.motion, work.response, body, place))
        for k in range(3):
            sample.probed[step, i, k] = force[k]


@kernel
def _rest(sections, memory, values):
    """Fill a filter's memory (direct form II, transposed) as if it had met the same values for ever."""
    for s in range(sections.shape[0]):
        for c in range(values.size):
            memory[s, 1, c] = (sections[s, 2] - sections[s, 4]) * values[c]
            memory[s, 0, c] = (sections[s, 1] - sections[s, 3]) * values[c] + memory[s, 1, c]


@inlined
def _filter(sections, memory, values):
    """Lead values (c,) through a filter of sections of second order, in place."""
    for s in range(sections.shape[0]):
        b0, b1, b2, a1, a2 = sections[s, 0], sections[s, 1], sections[s, 2], sections[s, 3], sections[s, 4]
        for c in range(values.size):
            x = values[c]
            y = b0 * x + memory[s, 0, c]
            memory[s, 0, c] = b1 * x - a1 * y + memory[s, 1, c]
            memory[s, 1, c] = b2 * x - a2 * y
            values[c] = y
