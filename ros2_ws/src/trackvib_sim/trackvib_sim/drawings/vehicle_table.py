"""A vehicle's parameters with their sources, and what follows from them, as rows of tables."""

import re
from math import sqrt
from typing import NamedTuple

from ..vehicle.body_tree import GRAVITY
from ..vehicle.tracks.layout import sink
from ..yaml_text import load
from .assembled_vehicle import assemble_vehicle
from .sprocket_drawing import free_entry, half_gap

SPEEDS = (5.0, 10.0, 20.0)  # m/s, those of [Tao2025]


class Parameter(NamedTuple):
    """An item of a vehicle file."""

    item: str
    value: str
    unit: str
    source: str
    note: str


class Figure(NamedTuple):
    """What follows from the parameters."""

    quantity: str
    value: str
    unit: str
    note: str


def parameters(text):
    """Return the `Parameter`s of a valid vehicle file's text by section, in its order."""
    return {
        section: [
            Parameter(item, _words(each["value"]), each["unit"], each["source"], each.get("note", ""))
            for item, each in items.items()
        ]
        for section, items in load(text, "the vehicle file").items()
    }


def figures(vehicle):
    """Return the `Figure`s of a `parameters.Vehicle`.

    Raises
    ------
    TrackDoesNotFit
        The links do not close round the running gear.
    """
    assembled, t, p, mounts = assemble_vehicle(vehicle), vehicle.tracks, vehicle.powertrain, vehicle.mr_mounts
    shoes, s, mm = 2.0 * t.links * t.shoe_mass, assembled.sprockets, 1e3
    load = p.mass * GRAVITY * p.centre[0] / (2.0 * mounts.place[0])
    gap, needed = (s.tip_radius * way(s)[1][-1] for way in (half_gap, free_entry))
    passing = ", ".join(f"{speed / t.pitch:.2f}" for speed in SPEEDS)
    speeds = ", ".join(f"{speed:g}" for speed in SPEEDS)
    rows = (
        ("mass", f"{1e-3 * assembled.mass:.2f}", "t", f"of it both tracks {1e-3 * shoes:.2f} t"),
        (
            "centre of mass",
            _words((assembled.centre.round(3) + 0.0).tolist()),
            "m",
            "from the road below the hull's origin",
        ),
        ("length of a track", f"{t.links * t.pitch:.3f}", "m", f"{t.links:g} links"),
        (
            "travel of the tensioners",
            f"{mm * assembled.travel:.1f}",
            "mm",
            "at which the track closes at its pretension",
        ),
        ("give of the tyres", f"{mm * sink(vehicle):.1f}", "mm", "under equal shares of the bodies' weight"),
        ("load on an MR mount", f"{1e-3 * load:.2f}", "kN", f"at rest; rated are {1e-3 * mounts.static_load:g} kN"),
        ("pitch radius of the sprockets", f"{mm * s.pitch_radius:.2f}", "mm", "the circle on which pins rest"),
        ("gap at the tip of the teeth", f"{mm * gap:.1f}", "mm", "from its middle to a flank"),
        ("gap for a free way in", f"{mm * needed:.1f}", "mm", "that a pin on the taut run needs there"),
        ("link-passing frequency v/p", passing, "Hz", f"at {speeds} m/s"),
        ("longest stable step", f"{1e3 * longest_step(vehicle):.3f}", "ms", "of a pin between two links on a tooth"),
    )
    return [Figure(*row) for row in rows]


def longest_step(vehicle):
    """Return the step [s] beyond which a pin diverges that shakes against both its links and a tooth.

    Links in counterphase act with 4 k and 4 c. Symplectic Euler is stable for h^2 k/m + 2 h c/m < 4 (Jury's criterion).
    """
    t, teeth = vehicle.tracks, vehicle.sprocket_teeth
    k = (4.0 * t.link_stiffness + teeth.stiffness) / t.shoe_mass
    c = (4.0 * t.link_damping + teeth.damping) / t.shoe_mass
    return (sqrt(c * c + 4.0 * k) - c) / k


def _words(value):
    """A word as it is; a number, or a list of numbers or lists, to six digits."""
    if isinstance(value, list):
        return f"[{', '.join(_words(each) for each in value)}]"
    try:
        number = float(value)  # YAML takes 4.0e7 for a text
    except ValueError:
        return value
    return re.sub(r"e\+?(-?)0*", r"e\1", f"{number:.6g}")
