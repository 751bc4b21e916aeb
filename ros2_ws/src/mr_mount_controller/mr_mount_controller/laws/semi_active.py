"""What semi-active laws share: a soft and a firm current, the estimated motion, and two ways to a current.

A mount can only dissipate: its damping force is c(I) times the velocity across it, against that velocity. `OnOffLaw`
chooses between the soft and the firm current; `DampingLaw` asks for a damping and gets what the mount has between the
two. Each mount gets a current of its own, by the velocity across it: that at the sensors, and what the powertrain's
turning against the hull makes of the lever to the mount. What the hull's own turning adds at both ends is left out.
Where the powertrain turns about a hinge only, mounts side by side move alike and get the same current. A firm mount is
a stiffer one as well, which no law can separate.
"""

from ..mount import HIGHEST_CURRENT, LOWEST_CURRENT
from ..node_base.parameters import Parameter, ParameterError
from .base import ControlLaw
from .estimator import MotionEstimator, levers, turning

SOFT = Parameter("soft_current", 0.8, "Current in the soft state.", "A", LOWEST_CURRENT, HIGHEST_CURRENT)
FIRM = Parameter("firm_current", 3.0, "Current in the firm state.", "A", LOWEST_CURRENT, HIGHEST_CURRENT)
CORNER = Parameter("corner", 0.5, "Corner frequency of the estimated velocities.", "Hz", 0.01, 10.0)
SEMI_ACTIVE = (SOFT, FIRM, CORNER)


def check_currents(soft, firm):
    """Raise `ParameterError` unless the soft current [A] is at most the firm one."""
    if soft > firm:
        raise ParameterError(f"parameter 'soft_current' is {soft!r}, accepted: at most firm_current, {firm:g} A")


class SemiActiveLaw(ControlLaw):
    """A current for each mount by the motion there: `current_for(motion)`.

    Mounts that move alike get the same: of them it is asked once a sample.
    """

    parameters = SEMI_ACTIVE

    def __init__(self, period, **values):
        super().__init__(period, **values)
        check_currents(self.soft_current, self.firm_current)

    def reset(self):
        """Forget the motion."""
        self._estimator = MotionEstimator(self.period, self.corner)
        self._levers = levers(self.mounting)
        self._different = sorted(set(self._levers))
        self._alike = self._different == [(0.0, 0.0)]

    def continue_from(self, earlier):
        """Keep the estimated motion, unless it shall be estimated otherwise."""
        if self.corner == earlier.corner:
            self._estimator = earlier._estimator

    def update(self, sample):
        """Return the current of each coil, or one if turning moves none."""
        return self.currents(self._estimator.update(sample), sample)

    def currents(self, motion, sample):
        """Return the same, given the `estimator.Motion` at the sensors."""
        if self._alike:
            return self.current_for(motion)
        x, y = turning(sample)
        found = {(a, b): self.current_for(motion.beside(a * x + b * y)) for a, b in self._different}
        return [found[lever] for lever in self._levers]

    def current_for(self, motion):
        """Return the current [A] of a mount in a state of `estimator.Motion`."""
        raise NotImplementedError


class OnOffLaw(SemiActiveLaw):
    """Firm while `is_firm(motion)`, else soft."""

    def current_for(self, motion):
        """Return the firm or the soft current."""
        return self.firm_current if self.is_firm(motion) else self.soft_current

    def is_firm(self, motion):
        """Return whether a mount shall be firm in a state of `estimator.Motion`."""
        raise NotImplementedError


class DampingLaw(SemiActiveLaw):
    """The current at which a mount comes nearest to `damping_for(motion)`, between soft and firm."""

    def reset(self):
        """Forget the motion."""
        super().reset()
        curve = self.mounting.curve
        self._softest, self._firmest = curve.damping(self.soft_current), curve.damping(self.firm_current)

    def current_for(self, motion):
        """Return the current."""
        wanted = self.damping_for(motion)
        if not wanted > self._softest:  # nor where it is no number
            return self.soft_current
        if wanted >= self._firmest:
            return self.firm_current
        return self.mounting.curve.current_for_damping(wanted)

    def damping_for(self, motion):
        """Return the wanted damping of a mount [N s/m], any number, in a state of `estimator.Motion`."""
        raise NotImplementedError


def share_of_velocity(velocity, relative_velocity):
    """Return velocity / relative_velocity where a damper across the mounts can act as one on `velocity` would, else 0.

    A damper can only brake the relative velocity, so it can where both have the same sign.
    """
    return velocity / relative_velocity if velocity * relative_velocity > 0.0 else 0.0
