"""What semi-active laws share: a soft and a firm current, the estimated motion, and two ways to a current.

A mount can only dissipate: its damping force is c(I) times the velocity across it, against that velocity. `OnOffLaw`
chooses between the soft and the firm current; `DampingLaw` asks for a damping and gets what the mount has between the
two. Both mounts get the same current: the rear hinge lets the powertrain pitch only, so that they move alike. A firm
mount is a stiffer one as well, which no law can separate.
"""

from ..mount import HIGHEST_CURRENT, LOWEST_CURRENT, current_for_damping, damping
from ..node_base.parameters import Parameter, ParameterError
from .base import ControlLaw
from .estimator import MotionEstimator

SOFT = Parameter("soft_current", 0.8, "Current of the soft mount.", "A", LOWEST_CURRENT, HIGHEST_CURRENT)
FIRM = Parameter("firm_current", 3.0, "Current of the firm mount.", "A", LOWEST_CURRENT, HIGHEST_CURRENT)
CORNER = Parameter("corner", 0.5, "Corner frequency of the estimated velocities.", "Hz", 0.01, 10.0)
SEMI_ACTIVE = (SOFT, FIRM, CORNER)


def check_currents(soft, firm):
    """Raise `ParameterError` unless the soft current [A] is at most the firm one."""
    if soft > firm:
        raise ParameterError(f"parameter 'soft_current' is {soft!r}, accepted is at most firm_current, {firm:g} A")


class OnOffLaw(ControlLaw):
    """Firm while `is_firm(motion)`, else soft."""

    parameters = SEMI_ACTIVE

    def __init__(self, period, **values):
        super().__init__(period, **values)
        check_currents(self.soft_current, self.firm_current)

    def reset(self):
        """Forget the motion."""
        self._estimator = MotionEstimator(self.period, self.corner)

    def update(self, sample):
        """Return the firm or the soft current."""
        return self.firm_current if self.is_firm(self._estimator.update(sample)) else self.soft_current

    def is_firm(self, motion):
        """Return whether the mounts shall be firm in a state of `estimator.Motion`."""
        raise NotImplementedError


class DampingLaw(ControlLaw):
    """The current at which a mount comes nearest to `damping_for(motion)`, between soft and firm."""

    parameters = SEMI_ACTIVE

    def __init__(self, period, **values):
        super().__init__(period, **values)
        check_currents(self.soft_current, self.firm_current)
        self._softest, self._firmest = damping(self.soft_current), damping(self.firm_current)

    def reset(self):
        """Forget the motion."""
        self._estimator = MotionEstimator(self.period, self.corner)

    def update(self, sample):
        """Return the current."""
        wanted = self.damping_for(self._estimator.update(sample))
        if not wanted > self._softest:  # nor where it is no number
            return self.soft_current
        if wanted >= self._firmest:
            return self.firm_current
        return current_for_damping(wanted)

    def damping_for(self, motion):
        """Return the wanted damping of a mount [N s/m], any number, in a state of `estimator.Motion`."""
        raise NotImplementedError


def share_of_velocity(velocity, relative_velocity):
    """Return velocity / relative_velocity where a damper across the mounts can act as one on `velocity` would, else 0.

    A damper can only brake the relative velocity, so it can where both have the same sign.
    """
    return velocity / relative_velocity if velocity * relative_velocity > 0.0 else 0.0
