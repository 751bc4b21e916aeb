"""A law of one's own: the busier the mounts, the firmer they are."""

from math import exp, sqrt

from mr_mount_controller.laws.base import ControlLaw
from mr_mount_controller.laws.estimator import MotionEstimator
from mr_mount_controller.node_base.parameters import Parameter


class BusyFirm(ControlLaw):
    """Current that grows from 0.8 A with the recent RMS velocity across the mounts, up to 3 A."""

    parameters = (
        Parameter("slope", 40.0, "Current gained by RMS velocity across the mounts.", "A s/m", 0.0, 1000.0),
        Parameter("memory", 0.5, "Time constant of the mean square.", "s", 0.01, 10.0),
    )

    def reset(self):
        """Forget the motion."""
        self._motion = MotionEstimator(self.period, 0.5)
        self._decay = exp(-self.period / self.memory)
        self._mean_square = 0.0

    def update(self, sample):
        """Return the current of all coils [A]."""
        velocity = self._motion.update(sample).relative_velocity
        self._mean_square = self._decay * self._mean_square + (1.0 - self._decay) * velocity**2
        return min(0.8 + self.slope * sqrt(self._mean_square), 3.0)
