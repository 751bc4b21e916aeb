"""Vehicles of many kinds, made of the shipped one: stations, rollers, drive end, sides, mounts, bodies, sensors."""

import numpy as np
import yaml
from hypothesis import strategies as st
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.parameters import Vehicle
from trackvib_sim.vehicle.tracks.layout import room_for_links

SPACING = 0.85  # m between road wheels
SHORTEST = 1.7  # m between the outermost ones: on less these 42 t topple
RADIUS = 0.375  # m of the wheels


def quantity(value, unit):
    """Return a quantity as a vehicle file has it."""
    return {"value": value, "unit": unit, "source": "assumed"}


_CABIN = {
    "mass": quantity(900.0, "kg"),
    "centre": quantity([0.0, 0.0, 0.3], "m"),
    "inertia": quantity([180.0, 190.0, 140.0], "kg m^2"),
    "products": quantity([0.0, 0.0, 0.0], "kg m^2"),
    "place": quantity([0.6, 0.4, 0.7], "m"),
}
CABINS = {
    "elastic": {
        "stiffness": quantity([4e6, 4e6, 4e5], "N/m"),
        "damping": quantity([1e4, 1e4, 1e4], "N s/m"),
        "turning_stiffness": quantity([2e5, 2e5, 2e5], "N m/rad"),
        "turning_damping": quantity([500.0, 500.0, 500.0], "N m s/rad"),
    },
    "free": {},
    "fixed": {},
}  # hinge: what belongs to it


def yielding(vehicle):
    """Return a vehicle whose MR mounts carry 0.3 kN and 1.2 kN an ampere at most by their field."""
    kinds = {
        name: kind.model_copy(update={"yield_force_fit": [0.0, 0.0, 1.2, 0.3]}) if kind.kind == "mr" else kind
        for name, kind in vehicle.mount_types.items()
    }
    return vehicle.model_copy(update={"mount_types": kinds})


@st.composite
def vehicles(draw, **given):
    """Draw a `Vehicle`; `given` are values of `made`'s parameters that are not drawn."""
    stations = draw(st.integers(2, 12))
    drawn = {
        "stations": stations,
        "stagger": draw(st.sampled_from([0.0, -0.085, 0.06])),
        "leading": draw(st.integers(0, stations)),
        "rollers": draw(st.integers(0, 4)),
        "front_drive": draw(st.booleans()),
        "turret": draw(st.booleans()),
        "mounts": draw(st.integers(3, 8)),
        "coils": draw(st.integers(0, 3)),
        "cabin": draw(st.sampled_from([None, *CABINS])),
    }
    return made(**(drawn | given))


def made(stations, stagger, leading, rollers, front_drive, turret, mounts, coils, cabin):
    """Return the `Vehicle`: its first `leading` stations have leading arms, its powertrain is free on its mounts.

    `cabin` is the hinge of a driver's cabin, or None for a vehicle without one.
    """
    content = yaml.safe_load(find_vehicle().read_text(encoding="utf-8"))
    if not turret:
        del content["bodies"]
    _stations(content, stations, stagger, leading)
    _ends(content, stations, rollers, front_drive)
    _powertrain(content, mounts, coils)
    if cabin:
        content.setdefault("bodies", {})["cabin"] = _CABIN | {"hinge": cabin} | CABINS[cabin]
        content["sensors"] = {"driver": {"body": "cabin", "place": quantity([0.0, 0.0, 0.1], "m")}}
    if cabin == "free":
        content["mounts"] |= _cabin_mounts()
    return _with_links(content)


def _half_base(stations):
    return 0.5 * max(SHORTEST, SPACING * (stations - 1))


def _stations(content, stations, stagger, leading):
    arms = content["swing_arms"]
    x = _half_base(stations) * np.linspace(1.0, -1.0, stations)
    arms["wheel_x"] = quantity((x - 0.5 * stagger).tolist(), "m")
    arms["right_wheel_x"] = quantity((x + 0.5 * stagger).tolist(), "m")
    arms["direction"] = quantity(["leading"] * leading + ["trailing"] * (stations - leading), "-")
    # the weight is that of six stations
    arms["wheel_rate"] = quantity(1.9e5 * 6 / stations, "N/m")
    content["shock_absorbers"]["damping"] = quantity(5e4, "N s/m")
    content["tyres"]["radial_stiffness"] = quantity(6.9e6 * 6 / stations, "N/m")


def _ends(content, stations, rollers, front_drive):
    outside = _half_base(stations) + 0.9
    drive = 1.0 if front_drive else -1.0
    content["sprockets"]["x"], content["idlers"]["x"] = quantity(drive * outside, "m"), quantity(-drive * outside, "m")
    if rollers:
        x = outside * (1.0 - 2.0 * (1.0 + np.arange(rollers)) / (rollers + 1.0))
        content["carrier_rollers"]["x"] = quantity(x.tolist(), "m")
        content["carrier_rollers"]["z"] = quantity([0.92] * rollers, "m")
    else:
        del content["carrier_rollers"], content["roller_rims"]
    content["powertrain"]["place"] = quantity([-0.4 * outside, 0.0, 0.8], "m")


def _powertrain(content, mounts, coils):
    powertrain = content["powertrain"]
    for item in ("axis", "stiffness", "damping"):
        del powertrain[item]
    powertrain["hinge"] = "free"
    stiffness = quantity([1.5e6, 1.2e6, 2e6], "N/m")
    damping = quantity([3e3] * 3, "N s/m")
    content["mount_types"]["rubber"] = {"kind": "rubber", "stiffness": stiffness, "damping": damping}
    angle = 2.0 * np.pi * np.arange(mounts) / mounts
    places = np.stack((0.55 + 0.8 * np.cos(angle), 0.5 * np.sin(angle), 0.05 * np.cos(2.0 * angle)), axis=1)
    content["mounts"] = {
        f"mount_{k}": {
            "type": "mr" if k < coils else "rubber",
            "place": quantity(place.tolist(), "m"),
            "orientation": quantity([0.0, 0.0, float(np.degrees(angle[k])) - 180.0], "deg"),
        }
        for k, place in enumerate(places)
    }


def _cabin_mounts():
    """One MR mount and three of rubber."""
    places = {"cabin_1": (0.4, 0.4, -0.3), "cabin_2": (0.4, -0.4, -0.3), "cabin_3": (-0.4, 0.4, -0.3)}
    places["cabin_4"] = (-0.4, -0.4, -0.3)
    return {
        name: {"type": "mr" if name == "cabin_2" else "rubber", "body": "cabin", "place": quantity(list(place), "m")}
        for name, place in places.items()
    }


def _with_links(content):
    """The vehicle with as many links a side as go round its running gear."""
    vehicle = Vehicle.model_validate(content)
    links = [round(np.mean(room_for_links(vehicle, side))) for side in range(2)]
    content["tracks"]["links"] = quantity(links, "-")
    return Vehicle.model_validate(content)
