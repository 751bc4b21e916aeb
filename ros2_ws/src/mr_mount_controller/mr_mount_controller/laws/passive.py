"""Passive mounts: one constant current."""

from ..node_base.parameters import Parameter
from .base import ControlLaw


class Passive(ControlLaw):
    """Holds one current whatever happens; the baseline for every other law."""

    parameters = (Parameter("current", 1.0, "Constant current in all mounts.", "A", 0.0, 5.0),)

    def update(self, sample):
        """Return the constant current."""
        return self.current
