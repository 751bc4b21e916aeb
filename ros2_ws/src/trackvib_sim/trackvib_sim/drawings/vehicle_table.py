"""A vehicle's parameters with their sources, and what follows from them, as rows of tables."""

import re
from math import degrees, pi
from typing import NamedTuple

from ..scene.teeth import half_gap
from ..vehicle.mount_loads import loads_at_rest
from ..vehicle.standing import standing
from ..vehicle.step_size import fastest_contact, longest_step, recommended_rate
from ..vehicle.tracks.layout import sink
from ..yaml_text import load
from .assembled_vehicle import assemble_vehicle
from .sprocket_drawing import free_entry

SPEEDS = (5.0, 10.0, 20.0)  # m/s, those of [Tao2025]


class Parameter(NamedTuple):
    """An item of a vehicle file."""

    item: str
    value: str
    unit: str
    source: str
    note: str


class Figure(NamedTuple):
    """A quantity derived from the parameters."""

    quantity: str
    value: str
    unit: str
    note: str


def parameters(text):
    """Return the `Parameter`s of a valid vehicle file's text by section, in its order.

    Sections within others have the names of both, such as "bodies.turret"; what stands in none is in "vehicle".
    """
    return dict(_sections("", load(text, "the vehicle file")))


def _sections(name, content):
    items = {item: each for item, each in content.items() if each is not None}
    inner = {item: each for item, each in items.items() if isinstance(each, dict) and "value" not in each}
    own = [_parameter(item, each) for item, each in items.items() if item not in inner]
    if own:
        yield name or "vehicle", own
    for item, each in inner.items():
        yield from _sections(f"{name}.{item}".lstrip("."), each)


def _parameter(item, each):
    """A quantity with unit and source, or a bare word."""
    if not isinstance(each, dict):
        return Parameter(item, str(each), "", "", "")
    return Parameter(item, _words(each["value"]), each["unit"], each["source"], each.get("note", ""))


def figures(vehicle):
    """Return the `Figure`s of a `parameters.Vehicle`.

    Raises
    ------
    TrackDoesNotFit
        The links do not close round the running gear.
    NoEquilibrium
        The vehicle cannot stand.
    """
    assembled = assemble_vehicle(vehicle)
    rows = (*_masses(assembled), *_loads(vehicle), *_tracks(assembled), *_teeth(assembled), *_rates(vehicle))
    return [Figure(*row) for row in rows]


def _masses(assembled):
    t = assembled.vehicle.tracks
    centre = _words((assembled.centre.round(3) + 0.0).tolist())
    yield "mass", f"{1e-3 * assembled.mass:.2f}", "t", f"of which tracks: {1e-3 * sum(t.links) * t.shoe_mass:.2f} t"
    yield "centre of mass", centre, "m", "from the road below the hull's origin"


def _loads(vehicle):
    loads, trimmed = standing(vehicle), loads_at_rest(vehicle)
    yield "static sag", f"{1e3 * loads.sag:.1f}", "mm", "of the hull at rest below its static ride height"
    yield "static pitch", f"{degrees(loads.pitch) + 0.0:.2f}", "deg", "of the hull at rest, nose up"
    deflections = _by_side([[f"{1e3 * each:.0f}" for each in side] for side in loads.deflection])
    yield "static deflection of the torsion bars", deflections, "mm", "at the wheels, from front to rear"
    shares = _by_side(
        [[f"{100.0 * each:.0f}" for each in side] for side in loads.share(vehicle.swing_arms.bump_travel)]
    )
    yield "share of the wheel travel", shares, "%", "at rest, from unloaded bars to the bump stops"
    wheels = _by_side([[f"{1e-3 * load:.1f}" for load in side] for side in loads.wheel])
    yield "loads of the road wheels", wheels, "kN", "at rest, from front to rear"
    yield "compression of the tyres", f"{1e3 * sink(vehicle):.1f}", "mm", "under equal shares of the bodies' weight"
    for name, force in loads.mount.items():
        along = _words(((1e-3 * force).round(2) + 0.0).tolist())
        kind = vehicle.mount_types[vehicle.mounts[name].type].kind
        note = f"{kind}, at rest along x, y, z of the mount; {1e-3 * trimmed[name][2]:.2f} along z where its ends meet"
        yield f"load on mount {name}", along, "kN", note + (f"; {loads.current:g} A" if kind == "mr" else "")


def _tracks(assembled):
    t, mm = assembled.vehicle.tracks, 1e3
    length = _by_side([f"{links * t.pitch:.3f}" for links in t.links])
    yield "length of a track", length, "m", f"{_by_side([f'{links:g}' for links in t.links])} links"
    travel = _by_side([f"{mm * travel:.1f}" for travel in assembled.travel])
    yield "travel of the tensioners", travel, "mm", "forwards, where the track closes at its pretension"
    passing = ", ".join(f"{speed / t.pitch:.2f}" for speed in SPEEDS)
    yield "link-passing frequency v/p", passing, "Hz", f"at {', '.join(f'{speed:g}' for speed in SPEEDS)} m/s"


def _teeth(assembled):
    s, mm = assembled.sprockets, 1e3
    gap, needed = (s.tip_radius * way(s)[1][-1] for way in (half_gap, free_entry))
    yield "pitch radius of the sprockets", f"{mm * s.pitch_radius:.2f}", "mm", "the circle on which pins rest"
    yield "gap at the tip of the teeth", f"{mm * gap:.1f}", "mm", "from its middle to a flank"
    yield "gap for free entry", f"{mm * needed:.1f}", "mm", "needed there by a pin on the taut run"


def _rates(vehicle):
    contact, frequency = fastest_contact(vehicle)
    rate = recommended_rate(vehicle)
    yield "longest stable step", f"{1e3 * longest_step(vehicle):.3f}", "ms", "of a pin between two links"
    note = f"a pin {contact}, at {frequency / (2.0 * pi):.0f} Hz, then advances by {frequency / rate:.2f} rad per step"
    yield "recommended physics rate", f"{rate}", "Hz", note


def _by_side(pair):
    """One text for both sides if they are alike, else left and right."""
    left, right = (_listed(each) if isinstance(each, list) else each for each in pair)
    return left if left == right else f"left {left}, right {right}"


def _listed(words):
    return f"[{', '.join(words)}]"


def _words(value):
    """A word as it is; a number, or a list of numbers or lists, to six digits."""
    if isinstance(value, list):
        return _listed(_words(each) for each in value)
    try:
        number = float(value)  # YAML takes 4.0e7 for a text
    except ValueError:
        return value
    return re.sub(r"e\+?(-?)0*", r"e\1", f"{number:.6g}")
