"""The contract between a control law and whoever runs it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..mounting import PAIR


class Sample(NamedTuple):
    """The readings of both inertial sensors at the end of a period, in axes of their bodies (x forward, y left, z up).

    Specific force is acceleration less gravity (REP-145): +9.81 m/s^2 along z at rest. `ControlLaw.mounting` has the
    positions of the mounts relative to the sensors. All values are plain, finite floats, after the sensors' low-pass.

    Examples
    --------
    >>> from mr_mount_controller.laws import Sample
    >>> at_rest = Sample(1e-3, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0), (0.0, 0.0, 9.81), (0.0, 0.0, 0.0))
    >>> at_rest.powertrain_force[2]  # m/s^2
    9.81
    """

    time: float  # s, end of the period; simulated time where a simulator runs, counted from the start of the run
    chassis_force: tuple  # (3,) specific force of the hull at the mounts, m/s^2
    chassis_angular_velocity: tuple  # (3,) angular velocity, rad/s
    powertrain_force: tuple  # (3,) the same of the powertrain
    powertrain_angular_velocity: tuple


class LawError(RuntimeError):
    """A law raised an exception, or returned something that is not a current.

    The message is one sentence with the law's name, the time of the sample, and file and line of the law's own code.

    Examples
    --------
    >>> from mr_mount_controller.laws import LawError
    >>> issubclass(LawError, RuntimeError)
    True
    """


class ControlLaw:
    """Base class of control laws.

    A law turns each sample of the accelerations into the currents of the mounts' coils from that sample on. A
    subclass must have `update`; it may declare `parameters`, and extend `reset` and `__init__`. The same class runs on
    the controller node, in the loop in one process and in studies, and cannot distinguish them.

    Attributes
    ----------
    parameters : tuple of mr_mount_controller.node_base.parameters.Parameter
        Class attribute: name, default, description, unit and range of each, in the order in which documents list them.
        The node declares them as ROS parameters with these checks and descriptions, and the table in
        `docs/controllers.md` is generated from them. A name must be a Python identifier. It must differ from `law`,
        `sample_rate`, `coils` and `wait_for_recorder`, which belong to the node, and from the attributes here.
    period : float
        Sampling period [s], set by `__init__`. A law must run at any from 0.1 ms to 0.1 s, though not equally well.
    mounting : mr_mount_controller.mounting.Mounting
        The mounts by name, kind and place, the number of coils, and how the powertrain can turn on them. Before
        `run_on` is called it is the pair of [Tao2025]. A law must work for 0 to 16 coils.

    and one attribute for each parameter, with its value.

    What a law can rely on
    ----------------------
    * `__init__(period, **values)` is called once. Each value has the type of its default and is within its range; a
      missing value means the default. A subclass may extend it: it calls `super().__init__(period, **values)` first,
      which sets the attributes and calls `reset`. It refuses an invalid combination of values with `ParameterError`;
      the node then ends with that message.
    * `reset()` is called at the end of the base class's `__init__`, hence before the rest of a subclass's own
      `__init__`, and again whenever the time of the samples restarts, or `mounting` changes.
    * Parameters may change during a run. Another law of the class is then created with the new values; `run_on` gives
      it the mounts, and `continue_from(earlier)` the previous law. It answers from the next sample on. If its
      `__init__` refuses the values, the change is refused and the previous law continues.
    * `update(sample)` is called once for each sample, in order of time. Samples are one period apart; if one is lost,
      the next one still comes, its time shows the gap, and the node counts it. All calls come from one thread, none
      before `reset`.

    What a law must do
    ------------------
    * `update` returns one finite current [A] for all coils, or as many as there are coils, in their order: floats,
      ints, or a numpy array of them. Any finite value is valid: the driver limits it (0 to 5 A on the default
      vehicle), the mounts use 0.7 to 4 A, and limited values are counted. Anything else ends the run with `LawError`.
      The current takes about 8 ms to build up in the coil.
    * `update` returns quickly. In lock-step the simulator waits for it; in real time a late answer is used late. At
      1 kHz about 0.1 ms are available; the laws here take less than about 10 us.
    * After `reset` the law behaves like a new one; `reset` is the best place to initialise memory.
    * The same samples give the same currents, to the last bit, wherever the law runs. It must therefore not read a
      clock, draw unseeded random numbers, start threads, read files in `update`, or depend on the order of a set.
    * It may keep anything in `self`, but must not change the sample, its class or its module.
    * It need not catch exceptions: one that `update` raises ends the run with `LawError`, which tells file and line.

    See Also
    --------
    estimator.MotionEstimator : velocities at both sensors
    semi_active.OnOffLaw, semi_active.DampingLaw : bases with soft and firm current and estimated motion

    Examples
    --------
    Firm while the powertrain is pushed up:

    >>> from mr_mount_controller.laws import ControlLaw, Parameter, Sample
    >>> class Upwards(ControlLaw):
    ...     parameters = (Parameter("firm", 2.5, "Current on the way up.", "A", 0.7, 4.0),)
    ...
    ...     def update(self, sample):
    ...         return self.firm if sample.powertrain_force[2] > 9.81 else 1.0
    >>> law = Upwards(1e-3, firm=3.0)
    >>> law.update(Sample(1e-3, (0.0, 0.0, 9.8), (0.0, 0.0, 0.0), (0.0, 0.0, 9.9), (0.0, 0.0, 0.0)))
    3.0
    """

    parameters = ()
    mounting = PAIR

    def __init__(self, period, **values):
        self.period = period
        for parameter in self.parameters:
            setattr(self, parameter.name, values.get(parameter.name, parameter.default))
        self.reset()

    def run_on(self, mounting):
        """Restart on the mounts of a `mounting.Mounting`."""
        self.mounting = mounting
        self.reset()

    def reset(self):
        """Reset the memory."""

    def continue_from(self, earlier):
        """Take over the memory of a law of this class with other parameters, as far as it holds for these.

        By default nothing, as after `reset`: correct for every law, though not smooth for those with a long memory.
        """

    def update(self, sample: Sample) -> float | Sequence[float] | np.ndarray:
        """Return the current [A] that answers a `Sample`: one for all coils, or one for each."""
        raise NotImplementedError
