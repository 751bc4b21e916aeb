"""Driver and coil of the mounts, from the demanded current to that of the magnetic field.

The demand waits for the driver's delay, is cut to its limits and becomes the reference, which rises and falls no faster
than the slew rate. The driver then puts a voltage on the coil, L di/dt + R i = v, and the field follows the current
with the lag of the eddy currents. Two models of the driver:

* `lag`: v = R times the reference, of any size. The current follows with the coil's own lag L/R = `time_constant`.
* `current_loop`: v = R (reference + g (reference - i)), feed-forward and proportional, within `voltage_limits`. While
  they do not limit it the current follows with the lag `loop_time_constant`, as under a PI controller whose zero
  cancels the coil's pole. Nothing integrates, so nothing winds up.

The driver samples at the physics steps and holds its voltage between them, where coil and eddy currents are linear and
solved exactly.
"""

from math import exp, inf
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from ..numerics.compiled import inlined

_EXACT = 1e-6  # of a physics step


class Coil(NamedTuple):
    """All MR mounts have the same driver and coil. Voltages are told by the current that they hold, v/R."""

    delay: int  # physics steps
    lowest: float  # A, what the driver may be asked for
    highest: float  # A
    slew: float  # A a step
    gain: float  # g, of the current loop
    least_held: float  # A at the lowest voltage
    most_held: float  # A at the highest one
    decay: float  # of the current towards the held one, a step
    field_decay: float  # the same of the field at a constant current
    field_share: float  # of the current's distance from the held one in the field's, after a step


class CoilState(NamedTuple):
    """Of c coils, in the order of the mounts."""

    waiting: np.ndarray  # (c, delay) demanded currents on their way, oldest first, A
    reference: np.ndarray  # (c,) of the driver, A
    current: np.ndarray  # (c,) in the coils, A
    field: np.ndarray  # (c,) that would hold the magnetic field as it is; what the mounts feel, A


def delay_fits(vehicle, dt):
    """Return whether the driver's delay is a whole number of physics steps of dt [s]."""
    steps = vehicle.coil.delay / dt
    return abs(steps - round(steps)) <= _EXACT


def build_coil(vehicle, dt):
    """Return the record for physics steps of dt [s].

    Raises
    ------
    ValueError
        The delay is no whole number of steps.
    """
    c = vehicle.coil
    if not delay_fits(vehicle, dt):
        raise ValueError(f"coil.delay is {c.delay:g} s, must be a whole number of physics steps of {dt:g} s")
    if c.model == "lag":
        gain, least_held, most_held, lag = 0.0, -inf, inf, c.time_constant
    else:
        least_held, most_held = (voltage / c.resistance for voltage in c.voltage_limits)
        lag = c.inductance / c.resistance
        gain = (exp(-dt / lag) - exp(-dt / c.loop_time_constant)) / (1.0 - exp(-dt / lag))
    return Coil(
        round(c.delay / dt),
        *c.current_limits,
        c.slew_rate * dt if c.slew_rate > 0.0 else inf,
        gain,
        least_held,
        most_held,
        *_decays(lag, c.eddy_time_constant, dt),
    )


def _decays(lag, eddy_lag, dt):
    """Return the last three items of `Coil` for two lags [s] in series, the second one zero or not."""
    if eddy_lag == 0.0:
        return exp(-dt / lag), 0.0, exp(-dt / lag)
    step = expm(dt * np.array([[-1.0 / lag, 0.0], [1.0 / eddy_lag, -1.0 / eddy_lag]]))
    return float(step[0, 0]), float(step[1, 1]), float(step[1, 0])


def usable_current(vehicle):
    """Return the range of demanded current that neither the driver nor the end of the mounts' fits cuts [A]."""
    used = {mount.type for mount in vehicle.mounts.values()}
    kinds = [vehicle.mount_types[name] for name in used]
    low, high = vehicle.coil.current_limits
    ends = [kind.current_range[1] for kind in kinds if kind.kind == "mr"]
    return np.array([max(low, 0.0), min([high, *ends])])


def new_coil_state(coil, count):
    """Return the state of so many coils without any current."""
    return CoilState(np.zeros((count, coil.delay)), np.zeros(count), np.zeros(count), np.zeros(count))


def settle_coils(coil, coils, demanded):
    """Bring a `CoilState` to where it comes to rest under a demanded current [A]."""
    for part in coils:
        part[:] = min(max(demanded, coil.lowest), coil.highest)


@inlined
def drive_coils(coil, demanded, coils):
    """Let all coils follow the demanded currents (c,) [A] for one step."""
    for i in range(coils.current.size):
        current, reference = coils.current[i], coils.reference[i]
        target = min(max(_delayed(coils.waiting[i], demanded[i]), coil.lowest), coil.highest)
        reference = min(max(target, reference - coil.slew), reference + coil.slew)
        held = min(max(reference + coil.gain * (reference - current), coil.least_held), coil.most_held)
        coils.reference[i] = reference
        coils.current[i] = held + (current - held) * coil.decay
        coils.field[i] = held + (coils.field[i] - held) * coil.field_decay + (current - held) * coil.field_share


@inlined
def _delayed(waiting, demanded):
    """Put a demand at the end of the line, return the one at its head."""
    if waiting.size == 0:
        return demanded
    oldest = waiting[0]
    for k in range(1, waiting.size):
        waiting[k - 1] = waiting[k]
    waiting[-1] = demanded
    return oldest
