"""Reads vehicle files of former formats, as recordings hold them.

Format 1 had one vehicle, whose parts had fixed sections. In format 2 damping and stops of the arms were meant along the
wheel's arc, in format 3 they are vertical, as the wheel rate has always been.
"""

from math import cos, radians

FORMAT = 3
_ALONG_THE_ARC = {  # item: by which power of the cosine of the arm's static angle its vertical value is larger
    "swing_arms": {"friction": 2, "bump_stiffness": 2, "bump_damping": 2},
    "shock_absorbers": {"damping": 2, "blow_off_force": 1, "blow_off_damping": 2},
}
_OLD_SECTIONS = {"hull", "turret", "gun_mount", "recoil_part", "mr_mounts", "swing_arms"}
_AXES = {"turret": [0.0, 0.0, 1.0], "gun_mount": [0.0, -1.0, 0.0], "recoil_part": [1.0, 0.0, 0.0]}
_HINGES = {"turret": "revolute", "gun_mount": "revolute", "recoil_part": "prismatic"}
_PARENTS = {"turret": "hull", "gun_mount": "turret", "recoil_part": "gun_mount"}


def upgraded(content):
    """Return what a vehicle file holds in the present format; what is no file of a former one stays as it is."""
    if not isinstance(content, dict):
        return content
    first = "format" not in content and content.keys() >= _OLD_SECTIONS
    if not first and content.get("format") != 2:
        return content
    new = {name: dict(items) if isinstance(items, dict) else items for name, items in content.items()}
    try:
        return _made_vertical(_upgraded(new) if first else new)
    except (KeyError, TypeError, AttributeError, ValueError):
        return content  # is refused as it stands


def _made_vertical(new):
    level = cos(radians(float(new["swing_arms"]["static_angle"]["value"])))
    for section, items in _ALONG_THE_ARC.items():
        for item, power in items.items():
            quantity, factor = new[section][item], level**-power
            values = quantity["value"]  # numbers with an exponent may still be text
            scaled = [factor * float(each) for each in values] if isinstance(values, list) else factor * float(values)
            new[section][item] = quantity | {"value": scaled}
    return new | {"format": FORMAT}


def _upgraded(new):
    new |= {"name": "vehicle", "description": "read from a file of format 1"}
    new["bodies"] = {
        name: new.pop(name) | {"parent": _PARENTS[name], "hinge": hinge, "axis": _assumed(_AXES[name], "-")}
        for name, hinge in _HINGES.items()
    }
    new["powertrain"] |= {"hinge": "revolute", "axis": _assumed([0.0, 1.0, 0.0], "-")}
    _mounts(new)
    arms, shocks = new["swing_arms"], new["shock_absorbers"]
    arms["direction"] = _assumed("trailing", "-")
    damped = [int(station) for station in shocks.pop("stations")["value"]]
    damping = shocks["damping"]
    stations = range(1, len(arms["wheel_x"]["value"]) + 1)
    shocks["damping"] = damping | {"value": [damping["value"] if k in damped else 0.0 for k in stations]}
    for name in ("sprockets", "idlers"):
        for axis in "xz":
            (value,) = new[name][axis]["value"]
            new[name][axis] = new[name][axis] | {"value": value}
    return new


def _mounts(new):
    mr = new.pop("mr_mounts") | {"kind": "mr"}
    place, load = mr.pop("place"), mr.pop("static_load")
    x, y, z = place["value"]
    new["mount_types"] = {"mr": mr}
    new["mounts"] = {
        name: {"type": "mr", "place": place | {"value": [x, across, z]}, "static_load": load}
        for name, across in (("left", y), ("right", -y))
    }


def _assumed(value, unit):
    return {"value": value, "unit": unit, "source": "assumed"}
