"""Acceleration-driven damping (ADD), and its mixture with skyhook.

[Savaresi2005] S. M. Savaresi, E. Silani, S. Bittanti, "Acceleration-driven-damper (ADD): an optimal control algorithm
for comfort-oriented semiactive suspensions", J. Dyn. Syst. Meas. Control 127 (2005) 218-229: without preview, the
damping that keeps the body's acceleration smallest is firm while acceleration and relative velocity point the same way.
[Savaresi2007] S. M. Savaresi, C. Spelta, "Mixed sky-hook and ADD: approaching the filtering limits of a semi-active
suspension", J. Dyn. Syst. Meas. Control 129 (2007) 382-392: skyhook is the better of the two around the resonance of
the body and ADD above it; acceleration^2 - w^2 velocity^2 tells on which side of w the motion is.
"""

from math import pi

from ..node_base.parameters import Parameter
from .semi_active import SEMI_ACTIVE, OnOffLaw

CROSSOVER = Parameter("crossover", 10.0, "Crossover frequency: skyhook acts below it, ADD above it.", "Hz", 0.1, 200.0)


class AccelerationDriven(OnOffLaw):
    """Firm while the powertrain's acceleration and its velocity against the hull point the same way, else soft."""

    def is_firm(self, motion):
        """Return whether the mounts brake the powertrain's acceleration."""
        return motion.acceleration * motion.relative_velocity > 0.0


class MixedSkyhookAdd(OnOffLaw):
    """Skyhook while the powertrain moves slower than the crossover frequency, ADD while it moves faster."""

    parameters = (*SEMI_ACTIVE, CROSSOVER)

    def is_firm(self, motion):
        """Return whether the mounts brake what decides at present."""
        slow = abs(motion.acceleration) <= 2.0 * pi * self.crossover * abs(motion.velocity)
        return (motion.velocity if slow else motion.acceleration) * motion.relative_velocity > 0.0
