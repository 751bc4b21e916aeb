"""The M113 with one thing changed, to show where differences from the reference come from."""

from collections.abc import Callable
from typing import NamedTuple

_MASSES = 1.52  # how much more a cylinder of a shoe moves here, of point masses at pins, than of rigid shoes
_SHOE = 18.02  # kg
_RIGHT = 52e3  # N as assembled, at which the longer right track is as taut as the left one


class Variant(NamedTuple):
    """What is changed, and how."""

    title: str
    change: Callable  # vehicle -> vehicle


def _with(**sections):
    """Return a function that changes items of a vehicle's sections."""

    def change(vehicle):
        changed = {name: getattr(vehicle, name).model_copy(update=items) for name, items in sections.items()}
        return vehicle.model_copy(update=changed)

    return change


def _stiffer_teeth(vehicle):
    teeth = vehicle.sprocket_teeth
    stiffer = {"stiffness": teeth.stiffness * _MASSES, "damping": teeth.damping * _MASSES}
    return _with(sprocket_teeth=stiffer)(vehicle)


BASE = "m113"
VARIANTS = {
    BASE: Variant("the vehicle file", lambda vehicle: vehicle),
    "frictionless teeth": Variant("no friction between teeth and shoes", _with(sprocket_teeth={"friction": 0.0})),
    "straight flanks": Variant(
        "straight flanks of 60 degrees, touched by the pins, as in the first rough likeness",
        _with(sprocket_teeth={"arc_centre": None, "arc_radius": None, "contacts": None, "flank_angle": 60.0}),
    ),
    "touched by pins": Variant(
        "arcs touched at the pins, not at the shoes' cylinders", _with(sprocket_teeth={"contacts": None})
    ),
    "equal tension": Variant("right track as taut as the left one", _with(tensioners={"force": [30e3, _RIGHT]})),
    "damped pins": Variant("pins with a damping of 1 N m s/rad", _with(tracks={"pin_damping": 1.0})),
    "ground with a spring": Variant(
        "ground that holds shoes by a spring of 1e6 N/m",
        _with(ground={"shear_stiffness": 1e6, "shear_damping": 3000.0}),
    ),
    "lighter shoes": Variant(
        f"shoes lighter by {_MASSES}, so that a cylinder moves as much as there",
        _with(tracks={"shoe_mass": _SHOE / _MASSES}),
    ),
    "stiffer teeth": Variant(f"teeth stiffer by {_MASSES}, so that a contact rings as there", _stiffer_teeth),
    "softer rims": Variant(
        "two contacts a wheel instead of eight",
        _with(
            tyres={"radial_stiffness": 0.90e6, "radial_damping": 770.0},
            idler_rims={"radial_stiffness": 0.66e6, "radial_damping": 660.0},
        ),
    ),
}
