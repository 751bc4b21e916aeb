"""Parameters of rigid bodies on hinges: superstructure, powertrain, seats, payloads, cabins."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from .quantities import vector
from .sections import Gain, Name, Place, RigidBodyParameters

HULL = "hull"


class BodyParameters(RigidBodyParameters):
    """A body tied to its parent; `place` is its hinge point, and its own origin, in the parent's axes."""

    parent: Name = HULL
    place: Place


class _AxisParameters(BodyParameters):
    axis: vector("-", 3)

    @model_validator(mode="after")
    def _some_way(self):
        if not any(self.axis):
            raise ValueError(f"axis is {self.axis}, must not be zero")
        return self


class RevoluteBodyParameters(_AxisParameters):
    """A body that turns about an axis, on a rotary spring and damper."""

    hinge: Literal["revolute"]
    stiffness: Gain("N m/rad")
    damping: Gain("N m s/rad")


class PrismaticBodyParameters(_AxisParameters):
    """A body that slides along an axis, on a spring and damper."""

    hinge: Literal["prismatic"]
    stiffness: Gain("N/m")
    damping: Gain("N s/m")


class ElasticBodyParameters(BodyParameters):
    """A body on a bushing: springs and dampers along and about the parent's three axes."""

    hinge: Literal["elastic"]
    stiffness: vector("N/m", 3, ge=0.0)
    damping: vector("N s/m", 3, ge=0.0)
    turning_stiffness: vector("N m/rad", 3, ge=0.0)
    turning_damping: vector("N m s/rad", 3, ge=0.0)


class FixedBodyParameters(BodyParameters):
    """A body that is one with its parent."""

    hinge: Literal["fixed"]


class FreeBodyParameters(BodyParameters):
    """A body with six degrees of freedom, held by mounts alone."""

    hinge: Literal["free"]


AnyBodyParameters = Annotated[
    RevoluteBodyParameters | PrismaticBodyParameters | ElasticBodyParameters | FixedBodyParameters | FreeBodyParameters,
    Field(discriminator="hinge"),
]
