"""On-off skyhook.

D. Karnopp, M. J. Crosby, R. A. Harwood, "Vibration control using semi-active force generators", J. Eng. Ind. 96 (1974)
619-626: a damper between the body and the sky is imitated by a damper between body and base, which is made firm while
its force points the way in which the skyhook's would, and soft otherwise.
"""

from ..parameters import Parameter
from .base import ControlLaw
from .estimator import WashoutIntegrator


class Skyhook(ControlLaw):
    """Firm while the powertrain's own vertical velocity and that against the hull point the same way, else soft."""

    parameters = (
        Parameter("soft_current", 0.8, "Current while the damper shall be soft.", "A", 0.0, 5.0),
        Parameter("firm_current", 3.0, "Current while the damper shall be firm.", "A", 0.0, 5.0),
        Parameter("corner", 0.5, "Corner frequency of the velocity estimates.", "Hz", 0.01, 10.0),
    )

    def reset(self):
        """Forget the velocities."""
        self._powertrain = WashoutIntegrator(self.period, self.corner)
        self._chassis = WashoutIntegrator(self.period, self.corner)

    def update(self, sample):
        """Return the firm or the soft current."""
        absolute = self._powertrain.update(sample.powertrain_force[2])
        relative = absolute - self._chassis.update(sample.chassis_force[2])
        return self.firm_current if absolute * relative > 0.0 else self.soft_current
