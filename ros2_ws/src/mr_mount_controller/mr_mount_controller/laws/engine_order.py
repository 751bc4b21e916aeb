"""Gain scheduling over the engine's orders: firm through the resonance, soft above the crossover.

Damping and stiffness hold the powertrain at its resonance on the mounts, and from sqrt(2) times its frequency on they
only pass the engine's forces on. An ideal mount is therefore stiff and damped at low frequency and soft above; see the
review of Y. Yu, N. G. Naganathan, R. V. Dukkipati, "A literature review of automotive vehicle engine mounting systems",
Mech. Mach. Theory 36 (2001) 123-142. The resonance on firm mounts follows from the description of the mounts; where the
engine's lowest order lies is estimated from the accelerations.
"""

from ..node_base.parameters import Parameter
from .base import ControlLaw
from .engine_speed import EngineSpeedEstimator
from .semi_active import FIRM, SOFT, check_currents

ORDER = Parameter("order", 2.0, "Lowest engine order that excites the powertrain.", "1/revolution", 0.5, 12.0)

_CROSSOVER = 2.0**0.5  # of the resonance; isolation begins there
_BLEND = 1.15  # from the crossover to this multiple of it the current goes from firm to soft


class EngineOrder(ControlLaw):
    """Firm while the engine's lowest order is below the crossover, or the speed not known; soft above it."""

    parameters = (SOFT, FIRM, ORDER)

    def __init__(self, period, **values):
        super().__init__(period, **values)
        check_currents(self.soft_current, self.firm_current)

    def reset(self):
        """Forget the engine's speed."""
        carried, coils = self.mounting.carried, self.mounting.coils
        self._engine = EngineSpeedEstimator(self.period, carried)
        self._crossover = _CROSSOVER * carried.resonance(coils, self.mounting.curve.stiffness(self.firm_current))

    def continue_from(self, earlier):
        """Keep what is known of the engine."""
        self._engine = earlier._engine

    def update(self, sample):
        """Return the current."""
        speed = self._engine.update(sample)
        if speed is None:
            return self.firm_current
        crossover = self._crossover
        beyond = self.order * speed / 60.0 - crossover
        softness = min(max(beyond / ((_BLEND - 1.0) * crossover), 0.0), 1.0)
        return (1.0 - softness) * self.firm_current + softness * self.soft_current
