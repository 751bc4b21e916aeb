"""The contract between a control law and whoever runs it."""

from typing import NamedTuple

import numpy as np


class Sample(NamedTuple):
    """What both inertial sensors measured over one period, in the axes of their bodies (x forward, y left, z up)."""

    time: float  # s, end of the period
    chassis_force: tuple  # specific force at the mounts' lower ends, m/s^2; +9.81 along z at rest
    chassis_rate: tuple  # angular velocity, rad/s
    powertrain_force: tuple  # the same at the mounts' upper ends
    powertrain_rate: tuple


class LawError(RuntimeError):
    """A law returned something that is not a current."""


class ControlLaw:
    """Base class of control laws.

    A law turns each sample of the accelerations into the currents that the mounts' coils shall carry from that sample
    on. Whoever runs it (the controller node, the loop in one process) promises:

    * `__init__(period, **values)` is called once, with the sampling period [s] and a value for every entry of
      `parameters`, each already checked against its range. A subclass that needs to prepare extends it and calls
      `super().__init__(period, **values)`, which stores the period, stores each value as an attribute of its name
      and calls `reset`.
    * `reset()` is called at the end of that and whenever the vehicle starts anew. After it the law must behave as if
      just made; a law that remembers sets up its memory here.
    * `update(sample)` is called once for every sample, in order of time, one period apart. It must return one finite
      current [A] for both mounts, or a pair (left, right). It may return any finite value: the driver cuts it to its
      limits, and the cut is counted.

    A law may keep whatever it likes in `self` between samples. It must not look at a clock, draw unseeded random
    numbers or start threads: the same samples must give the same currents, to the last bit, wherever the law runs.
    """

    parameters = ()  # mr_mount_controller.parameters.Parameter, in the order in which documents list them

    def __init__(self, period, **values):
        self.period = period
        for parameter in self.parameters:
            setattr(self, parameter.name, values.get(parameter.name, parameter.default))
        self.reset()

    def reset(self):
        """Forget the past."""

    def update(self, sample):
        """Return the current [A] that answers a `Sample`: one for both mounts or a pair (left, right)."""
        raise NotImplementedError


def answer(law, sample):
    """Return the law's currents (2,) [A] for a sample.

    Raises
    ------
    LawError
        The law returned something else than one or two finite numbers.
    """
    result = law.update(sample)
    try:
        numbers = np.asarray(result)
        # digits in a text and truth values are no currents, though numpy would make numbers of them
        currents = np.broadcast_to(numbers.astype(float) if numbers.dtype.kind in "fiu" else np.nan, (2,))
    except (TypeError, ValueError):
        currents = np.full(2, np.nan)
    if not np.isfinite(currents).all():
        raise LawError(
            f"law {type(law).__name__} answered {result!r} at t = {sample.time:.3f} s, "
            "must be one finite current [A] or a pair of them"
        )
    return currents
