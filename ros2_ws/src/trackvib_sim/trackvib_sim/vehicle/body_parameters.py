"""Parameters of rigid bodies on hinges: superstructure, powertrain, seats, payloads, cabins."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from ..rui.table import check_axis
from .quantities import vector
from .sections import Gain, Name, Place, RigidBodyParameters

HULL = "hull"


class BodyParameters(RigidBodyParameters):
    """A body tied to its parent; `place` is its hinge point, and its own origin, in the parent's axes."""

    parent: Name = HULL
    """Body that carries this one."""
    place: Place
    """Hinge point in the parent's axes; also this body's origin."""


class _AxisParameters(BodyParameters):
    axis: vector("-", 3)
    """Axis of the hinge in the parent's axes."""

    @model_validator(mode="after")
    def _some_way(self):
        check_axis("axis", self.axis)
        return self


class RevoluteBodyParameters(_AxisParameters):
    """A body that turns about an axis, on a rotary spring and damper."""

    hinge: Literal["revolute"]
    """Kind of hinge: turns about the axis."""
    stiffness: Gain("N m/rad")
    """Stiffness of the rotary spring."""
    damping: Gain("N m s/rad")
    """Damping about the axis."""


class PrismaticBodyParameters(_AxisParameters):
    """A body that slides along an axis, on a spring and damper."""

    hinge: Literal["prismatic"]
    """Kind of hinge: slides along the axis."""
    stiffness: Gain("N/m")
    """Stiffness of the spring along the axis."""
    damping: Gain("N s/m")
    """Damping along the axis."""


class ElasticBodyParameters(BodyParameters):
    """A body on a bushing: springs and dampers along and about the parent's three axes."""

    hinge: Literal["elastic"]
    """Kind of hinge: a bushing."""
    stiffness: vector("N/m", 3, ge=0.0)
    """Stiffness along x, y and z."""
    damping: vector("N s/m", 3, ge=0.0)
    """Damping along x, y and z."""
    turning_stiffness: vector("N m/rad", 3, ge=0.0)
    """Stiffness about x, y and z."""
    turning_damping: vector("N m s/rad", 3, ge=0.0)
    """Damping about x, y and z."""


class FixedBodyParameters(BodyParameters):
    """A body that is one with its parent."""

    hinge: Literal["fixed"]
    """Kind of hinge: none, one with the parent."""


class FreeBodyParameters(BodyParameters):
    """A body with six degrees of freedom, held by mounts alone."""

    hinge: Literal["free"]
    """Kind of hinge: none, held by mounts."""


AnyBodyParameters = Annotated[
    RevoluteBodyParameters | PrismaticBodyParameters | ElasticBodyParameters | FixedBodyParameters | FreeBodyParameters,
    Field(discriminator="hinge"),
]
