"""What step a vehicle's contacts need: how long it may be for stability, and how short it should be for the result.

The fastest motion is that of a pin that shakes against both its links, which act with 4 k and 4 c when neighbours are
in counterphase, and against what it touches.
"""

from math import sqrt
from typing import NamedTuple

from ..numerics.units import NANO
from .coil import delay_fits

# rad, the most that the fastest motion may advance in a step. Up to it no RMS changes by 5 % with a finer step, nor does
# a third octave up to 315 Hz by 10 % (bench/step_accuracy.py); beyond it steps soon come near the longest stable one.
NEEDED = 1.25
CLEAR = 1.15  # longest stable step over the longest recommended one
KILO = 1000
RATES = [rate for rate in range(KILO, KILO * KILO + 1, KILO) if NANO % rate == 0]  # Hz


class Contact(NamedTuple):
    """What holds a pin besides its links; across a link all that touches it acts at once."""

    name: str
    stiffness: float  # N/m
    damping: float  # N s/m


def contacts(vehicle):
    """Return the `Contact`s of pins with all else."""
    v = vehicle
    between = v.tyres.radial_stiffness + v.ground.stiffness, v.tyres.radial_damping + v.ground.damping
    found = [
        Contact("on a tooth", v.sprocket_teeth.stiffness, v.sprocket_teeth.damping),
        Contact("between road wheel and ground", *between),
        Contact("on an idler", v.idler_rims.radial_stiffness, v.idler_rims.radial_damping),
    ]
    if v.roller_rims is not None:
        found.append(Contact("on a roller", v.roller_rims.radial_stiffness, v.roller_rims.radial_damping))
    return found


def fastest_contact(vehicle):
    """Return the name of the contact with the highest undamped frequency, and that frequency [rad/s]."""
    stiffest = max(contacts(vehicle), key=lambda contact: contact.stiffness)
    t = vehicle.tracks
    return stiffest.name, sqrt((4.0 * t.link_stiffness + stiffest.stiffness) / t.shoe_mass)


def longest_step(vehicle):
    """Return the step [s] beyond which some pin diverges.

    Symplectic Euler is stable for h^2 k/m + 2 h c/m < 4 (Jury's criterion).
    """
    return min(_longest(vehicle.tracks, contact) for contact in contacts(vehicle))


def recommended_rate(vehicle, control=KILO):
    """Return the rate of physics steps [Hz] from which on the result hardly depends on it.

    The fastest undamped motion advances by `NEEDED` per step at most, and the step keeps clear of the longest stable
    one. The rate is a whole number of kHz that divides a second into whole nanoseconds, as rates must; where there is
    such a one, it is a multiple of the control rate [Hz] and divides the coils' delay into whole steps.
    """
    needed = max(fastest_contact(vehicle)[1] / NEEDED, CLEAR / longest_step(vehicle))
    enough = [rate for rate in RATES if rate >= needed] or RATES[-1:]
    return next((rate for rate in enough if rate % control == 0 and delay_fits(vehicle, 1.0 / rate)), enough[0])


def _longest(tracks, contact):
    k = (4.0 * tracks.link_stiffness + contact.stiffness) / tracks.shoe_mass
    c = (4.0 * tracks.link_damping + contact.damping) / tracks.shoe_mass
    return (sqrt(c * c + 4.0 * k) - c) / k
