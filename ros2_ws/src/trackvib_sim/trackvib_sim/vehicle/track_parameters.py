"""Parameters of tracks, of what touches their links, and of the ground: their sections of a vehicle file.

A quantity by side is one number for both, or a pair, left and right.
"""

from typing import Annotated

from pydantic import AfterValidator, model_validator

from .quantities import one_or_many, scalar, vector
from .sections import Gain, Length, Mass, Section
from .tracks.nodes import FEWEST_LINKS, MOST_LINKS

MOST_CONTACTS = 4  # of a link with a sprocket
SIDES = 2
LONGEST_SHEAR = 0.02  # s, of the ground's damping to its stiffness

by_side = lambda unit, **limits: Annotated[one_or_many(unit, SIDES, **limits), AfterValidator(_pair)]  # noqa: E731


def _pair(values):
    return values if len(values) == SIDES else values * SIDES


class RimsParameters(Section):
    """Where wheels, rollers or idlers touch the links: radial contact, friction, sideways guidance."""

    radial_stiffness: scalar("N/m", gt=0.0)
    """Radial stiffness of the rubber, of a link."""
    radial_damping: Gain("N s/m")
    """Radial damping of the rubber, of a link."""
    friction: Gain("-")
    """Coefficient of friction between link and rim."""
    guide_stiffness: Gain("N/m")
    """Sideways stiffness of the guide horns."""
    guide_damping: Gain("N s/m")
    """Sideways damping of the guide horns."""


class TeethParameters(Section):
    """Contact of the sprockets' teeth with the pins, or with what else of a shoe touches them.

    Seat and flanks are straight, or one concave arc: `arc_centre` is then the distance of its centre from the hub, and
    `arc_radius` its radius as the pins' centres see it. `contacts` are the places along a link, from its middle on,
    forwards on the lower run; without them the pins touch.
    """

    teeth: scalar("-", ge=6.0, le=40.0, multiple_of=1.0)
    """Number of teeth."""
    pitch_excess: scalar("-", gt=-0.1, lt=0.1)
    """By how much the sprocket's pitch exceeds the track's, as a part of it."""
    flank_angle: scalar("deg", ge=0.0, le=60.0)
    """Angle of the flanks to the radius."""
    backlash: Gain("m")
    """Play of a pin between two flanks."""
    height: Length
    """Height of a tooth above the seat."""
    corner_radius: Length
    """Radius of the tip's corners."""
    arc_centre: Length | None = None
    """Distance of the flank arc's centre from the hub."""
    arc_radius: Length | None = None
    """Radius of the flank arc; straight flanks where left out."""
    contacts: vector("m", most=MOST_CONTACTS) | None = None
    """Places along a link that touch the teeth; its pins where left out."""
    friction: Gain("-") | None = None
    """Coefficient of friction; 0 where left out."""
    stiffness: scalar("N/m", gt=0.0)
    """Stiffness of a contact."""
    damping: Gain("N s/m")
    """Damping of a contact."""
    guide_stiffness: Gain("N/m")
    """Sideways stiffness between tooth and link."""
    guide_damping: Gain("N s/m")
    """Sideways damping between tooth and link."""

    @model_validator(mode="after")
    def _whole_arc(self):
        if (self.arc_centre is None) != (self.arc_radius is None):
            raise ValueError("arc_centre and arc_radius: must be given both or neither")
        if self.arc_centre is not None and not self.arc_radius < self.arc_centre:
            raise ValueError(f"arc_radius is {self.arc_radius} m, must be less than arc_centre, {self.arc_centre} m")
        return self


class TensionersParameters(Section):
    """Slides that hold the idlers outwards.

    `force` is that of their springs with the idlers at their places; without it, it is what gives the taut tracks
    their pretension.
    """

    stiffness: Gain("N/m")
    """Stiffness of the slide's spring."""
    damping: Gain("N s/m")
    """Damping of the slide."""
    force: by_side("N", ge=0.0) | None = None
    """Force of the springs with the idlers in place; what gives the pretension where left out."""
    travel: Length
    """Travel of the idler either way."""


class TracksParameters(Section):
    """Links and pins of both tracks."""

    links: by_side("-", ge=float(FEWEST_LINKS), le=float(MOST_LINKS), multiple_of=1.0)
    """Number of links of a track."""
    pitch: scalar("m", ge=0.03, le=0.5)
    """Distance between the pins of a link."""
    shoe_mass: Mass
    """Mass of a link with its pin and pad."""
    link_stiffness: scalar("N/m", gt=0.0)
    """Stiffness along a link."""
    link_damping: Gain("N s/m")
    """Damping along a link."""
    pin_stiffness: Gain("N m/rad")
    """Bending stiffness of a pin's bushing."""
    pin_damping: Gain("N m s/rad")
    """Damping of a pin's bushing."""
    sideways_stiffness: Gain("N m/rad")
    """Sideways bending stiffness between two links."""
    pretension: by_side("N", ge=0.0)
    """Tension of a track at rest."""


class GroundParameters(Section):
    """The ground under one shoe. Without `shear_stiffness` it is viscous up to Coulomb's limit and keeps no shear."""

    stiffness: scalar("N/m", gt=0.0)
    """Vertical stiffness under a shoe."""
    damping: Gain("N s/m")
    """Vertical damping under a shoe."""
    shear_stiffness: Gain("N/m")
    """Stiffness against shear under a shoe; 0 for a viscous ground."""
    shear_damping: Gain("N s/m")
    """Damping of shear under a shoe."""
    friction: scalar("-", gt=0.0)
    """Coefficient of friction between shoe and ground."""

    @model_validator(mode="after")
    def _short_shear(self):
        # the spring of a sliding shoe is drawn to where spring and damper together give friction: by about speed times
        # this time, which must stay far below a shoe's length
        if self.shear_stiffness > 0.0 and self.shear_damping > LONGEST_SHEAR * self.shear_stiffness:
            raise ValueError(
                f"shear_damping / shear_stiffness is {self.shear_damping / self.shear_stiffness:.3g} s, "
                f"must be at most {LONGEST_SHEAR:g} s, or shear_stiffness 0"
            )
        return self
