"""What sections of a vehicle file are made of: common quantities, and the rigid body."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from .quantities import scalar, vector

Mass = scalar("kg", gt=0.0)
Length = scalar("m", gt=0.0)
Place = vector("m", 3)
Inertia = vector("kg m^2", 3, gt=0.0)
Products = vector("kg m^2", 3)
Angles = vector("deg", 3, ge=-180.0, le=180.0)
Gain = lambda unit: scalar(unit, ge=0.0)  # noqa: E731 - reads as the type it stands for
Range = lambda unit: vector(unit, 2, ge=0.0)  # noqa: E731
# parts of topics' and frames' names
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]


class Section(BaseModel):
    """A section of the file: unknown items are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class RigidBodyParameters(Section):
    """A rigid body: mass, centre from its origin, inertia about the centre (diagonal; products as matrix elements)."""

    mass: Mass
    """Mass."""
    centre: Place
    """Centre of mass, from the body's origin."""
    inertia: Inertia
    """Moments of inertia about x, y and z through the centre of mass."""
    products: Products
    """Products of inertia xy, xz and yz, as elements of the inertia matrix."""


def increasing(name, pair):
    """Raise `ValueError` unless the first of two numbers is below the second."""
    low, high = pair
    if not low < high:
        raise ValueError(f"{name} is [{low:g}, {high:g}], the first must be below the second")
