"""Parameters of mounts and of the coils in them: kinds of mounts, and where one of each stands."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from .quantities import choice, scalar, vector
from .sections import Angles, Gain, Mass, Name, Place, Range, Section, increasing


class MrMountParameters(Section):
    """Magnetorheological mounts: measured fits, their valid range, the other axes as ratios to the vertical one.

    With `yield_force_fit` what a field adds to the stiffness yields at that force (`mount_law`).
    """

    kind: Literal["mr"]
    """Magnetorheological."""
    stiffness_fit: vector("kN/mm, I in A", 4)
    """Stiffness along z over current: polynomial, highest power first."""
    damping_ratio_fit: vector("-, I in A", 4)
    """Damping ratio over current: polynomial, highest power first."""
    carried_mass: Mass
    """Mass to which the damping ratio refers."""
    current_range: Range("A")
    """Currents between which the fits are used."""
    yield_force_fit: vector("kN, I in A", 4) | None = None
    """Force at which the field's part of the stiffness yields: polynomial of current; without it, it never does."""
    rubber_damping_ratio: scalar("-", ge=0.0, le=0.5) = 0.02
    """Damping ratio of the rubber alone."""
    stiffness_ratio: vector("-", 2, ge=0.0)
    """Stiffness along x and y over that along z."""
    damping_ratio: vector("-", 2, ge=0.0)
    """Damping along x and y over that along z."""

    @model_validator(mode="after")
    def _stiff_over_the_range(self):
        increasing("current_range", self.current_range)
        currents = np.linspace(0.0, self.current_range[1], 201)
        for name, unit in (("stiffness_fit", "kN/mm"), ("yield_force_fit", "kN")):
            fit = getattr(self, name)
            least = np.inf if fit is None else np.polyval(fit, currents).min()
            if least <= 0.0:
                raise ValueError(
                    f"{name} falls to {least:.3g} {unit} between 0 A and the end of current_range, must stay > 0 there"
                )
        return self


class RubberMountParameters(Section):
    """Rubber mounts: stiffness by axis, and damping by axis or the loss factor at a frequency."""

    kind: Literal["rubber"]
    """Rubber."""
    stiffness: vector("N/m", 3, ge=0.0)
    """Stiffness along x, y and z."""
    damping: vector("N s/m", 3, ge=0.0) | None = None
    """Damping along x, y and z; or give the loss factor."""
    loss_factor: scalar("-", ge=0.0, le=2.0) | None = None
    """Loss factor of the rubber."""
    loss_frequency: scalar("Hz", gt=0.0) | None = None
    """Frequency at which the loss factor applies."""

    @model_validator(mode="after")
    def _damping_in_one_way(self):
        loss = self.loss_factor is not None, self.loss_frequency is not None
        if any(loss) != all(loss) or any(loss) == (self.damping is not None):
            raise ValueError("needs either damping, or loss_factor and loss_frequency")
        return self

    @property
    def damping_by_axis(self):
        """Damping (3,) [N s/m]; of a loss factor the viscous one that dissipates as much at its frequency."""
        if self.damping is not None:
            return np.array(self.damping)
        return self.loss_factor / (2.0 * np.pi * self.loss_frequency) * np.array(self.stiffness)


AnyMountKind = Annotated[MrMountParameters | RubberMountParameters, Field(discriminator="kind")]


class MountParameters(Section):
    """One mount between a body and that body's parent.

    `place` is its upper end in the body, where the lower end is as well when every coordinate is zero. `orientation`
    turns the mount's axes (roll, pitch, yaw about the fixed axes of the parent). What it carries there: `static_load`
    along its own z axis, or what its springs give with the unloaded end `unloaded_height` above, or, without either,
    its share of the body's weight.
    """

    type: Name
    """Kind of mount, a name in mount_types."""
    body: Name = "powertrain"
    """Body that it carries; its lower end is in that body's parent."""
    place: Place
    """Upper end in the body's axes."""
    orientation: Angles | None = None
    """Roll, pitch and yaw of the mount's axes; along the parent's where left out."""
    static_load: Gain("N") | None = None
    """Load that it carries along its z with the body in place; its share of the weight where left out."""
    unloaded_height: scalar("m") | None = None
    """Height of the unloaded upper end above its place; instead of static_load."""

    @model_validator(mode="after")
    def _one_load(self):
        if self.static_load is not None and self.unloaded_height is not None:
            raise ValueError("has both static_load and unloaded_height, must have one of them, or none")
        return self


class CoilParameters(Section):
    """Driver and coil of an MR mount."""

    model: choice("lag", "current_loop")
    """First-order lag of the current, or a current loop with voltage limits."""
    current_limits: Range("A")
    """Least and greatest current of the driver."""
    slew_rate: Gain("A/s")
    """Fastest change of the demanded current; 0 for no limit."""
    delay: scalar("s", ge=0.0, le=1.0)
    """Time from demand to effect."""
    time_constant: scalar("s", gt=0.0)
    """Time constant of the lag."""
    loop_time_constant: scalar("s", gt=0.0)
    """Time constant of the closed current loop."""
    voltage_limits: vector("V", 2)
    """Least and greatest voltage of the driver."""
    resistance: scalar("ohm", gt=0.0)
    """Resistance of the coil."""
    inductance: scalar("H", gt=0.0)
    """Inductance of the coil."""
    eddy_time_constant: Gain("s")
    """Time constant with which the field follows the current; 0 for at once."""

    @model_validator(mode="after")
    def _voltage_for_every_current(self):
        increasing("current_limits", self.current_limits)
        needed = [self.resistance * current for current in self.current_limits]
        if not (self.voltage_limits[0] <= needed[0] and needed[1] <= self.voltage_limits[1]):
            raise ValueError(
                f"voltage_limits are {self.voltage_limits} V, must hold {needed[0]:g} to {needed[1]:g} V, "
                "resistance times current_limits"
            )
        return self
