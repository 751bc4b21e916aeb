"""What sections of a vehicle file are made of: common quantities, and the rigid body."""

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from .quantities import scalar, vector

ROUNDED = 0.01  # by which moments of inertia may be rounded
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


def check_solid(inertia, products=(0.0, 0.0, 0.0)):
    """Raise `ValueError` for moments and products of inertia [kg m^2] that no rigid body has.

    Of the principal moments the greatest is at most the sum of the other two, which a thin plate reaches.
    """
    xy, xz, yz = products
    least, middle, greatest = np.linalg.eigvalsh(np.diag(inertia) + [[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])
    if least <= 0.0 or greatest > (1.0 + ROUNDED) * (least + middle):
        raise ValueError(
            f"inertia is {inertia} kg m^2, which no rigid body has: its principal moments are {least:.4g}, "
            f"{middle:.4g} and {greatest:.4g}, all must be above 0 and the greatest at most the sum of the others"
        )


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

    @model_validator(mode="after")
    def _solid(self):
        check_solid(self.inertia, self.products)
        return self


def increasing(name, pair):
    """Raise `ValueError` unless the first of two numbers is below the second."""
    low, high = pair
    if not low < high:
        raise ValueError(f"{name} is [{low:g}, {high:g}], the first must be below the second")
