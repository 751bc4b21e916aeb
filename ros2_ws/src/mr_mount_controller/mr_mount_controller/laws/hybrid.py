"""Continuous skyhook, groundhook, and the hybrid of both.

Skyhook [Karnopp1974] imitates a damper between powertrain and sky, groundhook [Valasek1997] one between hull and
ground; the hybrid [Ahmadian1997] wants a share of each. Where the damper between the two can give the wanted force it
gives just that, elsewhere the nearest to it: it is soft where it would do the opposite.

[Karnopp1974] D. Karnopp, M. J. Crosby, R. A. Harwood, "Vibration control using semi-active force generators", J. Eng.
Ind. 96 (1974) 619-626.
[Valasek1997] M. Valasek, M. Novak, Z. Sika, O. Vaculin, "Extended ground-hook - new concept of semi-active control of
truck's suspension", Veh. Syst. Dyn. 27 (1997) 289-303.
[Ahmadian1997] M. Ahmadian, "A hybrid semiactive control for secondary suspension applications", Proc. 6th ASME Symp.
on Advanced Automotive Technologies (1997).
"""

from ..node_base.parameters import Parameter
from .semi_active import SEMI_ACTIVE, DampingLaw, share_of_velocity

HOOK = Parameter("hook_damping", 4.0e4, "Damping of the virtual damper, per mount.", "N s/m", 0.0, 1.0e6)
SHARE = Parameter("skyhook_share", 0.5, "Share of skyhook; the rest is groundhook.", "", 0.0, 1.0)


class Hybrid(DampingLaw):
    """Wants the share of a skyhook on the powertrain and the rest of a groundhook on the hull."""

    parameters = (*SEMI_ACTIVE, HOOK, SHARE)

    def damping_for(self, motion):
        """Return the damping [N s/m] whose force is the wanted one."""
        across = motion.relative_velocity
        sky = share_of_velocity(motion.velocity, across)
        # the mounts' force on the hull is the reaction
        ground = share_of_velocity(-motion.base_velocity, across)
        return self.hook_damping * (self.skyhook_share * sky + (1.0 - self.skyhook_share) * ground)


class ContinuousSkyhook(Hybrid):
    """Wants a damper between the powertrain and the sky."""

    parameters = (*SEMI_ACTIVE, HOOK)
    skyhook_share = 1.0


class Groundhook(Hybrid):
    """Wants a damper between the hull and the ground, to calm the hull at the mounts."""

    parameters = (*SEMI_ACTIVE, HOOK)
    skyhook_share = 0.0
