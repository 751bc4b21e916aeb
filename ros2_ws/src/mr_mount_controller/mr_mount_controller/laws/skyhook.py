"""On-off skyhook.

D. Karnopp, M. J. Crosby, R. A. Harwood, "Vibration control using semi-active force generators", J. Eng. Ind. 96 (1974)
619-626: a damper between the body and the sky is imitated by a damper between body and base, which is made firm while
its force points the way in which the skyhook's would, and soft otherwise.
"""

from .semi_active import OnOffLaw


class Skyhook(OnOffLaw):
    """Firm while the powertrain's own vertical velocity and that against the hull point the same way, else soft."""

    def is_firm(self, motion):
        """Return whether the mounts brake the powertrain."""
        return motion.velocity * motion.relative_velocity > 0.0
