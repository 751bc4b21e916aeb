"""What of a vehicle is possible but not plausible, in sentences: most likely a wrong unit or a slip of the pen.

What no vehicle can have is refused where its file is read (`parameters`, `quantities`) or its bodies are tied together
(`rui.table`).
"""

import numpy as np
from mr_mount_controller.node_base.plain_text import span

from .body_tree import GRAVITY, SIDES, sprung_bodies, whole_mass
from .standing import standing
from .step_size import fastest_contact, recommended_rate
from .supports import SHOES_UNDER_WHEEL

# Ranges are about twice as wide as what is known of tracked vehicles, from a carrier of 2 t to a tank of 70 t.
WHEEL_LOAD = 200.0, 10_000.0  # kg on a road wheel: 300 of a light carrier, 5000 of a heavy tank
HULL_SHARE = 10.0, 98.0  # % of the whole mass; those included have 40 to 60
GAUGE = 0.8, 4.0  # m between the middles of the tracks
BOUNCE = 0.6, 6.0  # Hz; tanks have 1 to 2, the M113 with its stiff bars nearly 4
TRAVEL_SHARE = 2.0, 80.0  # % of the wheel travel at rest; the rest is for bumps, and the M113 has 5
HIGHEST_PITCH = 3.0  # deg at rest
MOST_SAG = 0.1  # m: static ride height is where the file says that the vehicle stands
MOUNT_GIVES = 0.01, 100.0  # mm; rubber mounts of powertrains give by 1 to 20
TYRE_GIVES = 0.05, 10.0  # % of a wheel's radius; rubber of 40 mm that gives by a tenth is worn soon
GROUND_GIVES = 0.01, 200.0  # mm; a paved road gives by 0.1, and what gives by more bogs a tank down
LINK_STRETCHES = 0.01, 10.0  # % of its pitch, where it carries half of the weight; bushings give by 1
HIGHEST_RATE = 20_000  # Hz; those included need 5000 at most


def doubts(vehicle):
    """Return sentences on what is not plausible in a vehicle (`parameters.Vehicle`); none where all is.

    Raises
    ------
    NoEquilibrium
        It cannot stand.
    TrackDoesNotFit
        The links do not close round the running gear.
    ValueError
        A body has moments of inertia that none can have.
    """
    return [sentence for sentence, good in _judged(vehicle) if not good]


def _judged(vehicle):
    wheels, whole = len(SIDES) * vehicle.swing_arms.stations, whole_mass(vehicle)
    share = 100.0 * vehicle.hull.mass / whole
    yield _within(f"each of {wheels} road wheels carries {{}} of the vehicle's mass", whole / wheels, WHEEL_LOAD, "kg")
    yield _within(f"hull.mass is {vehicle.hull.mass:.6g} kg, {{}} of the vehicle's mass", share, HULL_SHARE, "%")
    yield _within("the tracks are {} apart", 2.0 * vehicle.road_wheels.y, GAUGE, "m")
    found = standing(vehicle)
    sprung = sum(body.mass for body in sprung_bodies(vehicle).values())
    rate = wheels * np.mean(vehicle.swing_arms.wheel_rate)
    words = f"{1e-3 * sprung:.3g} t on wheel rates of {rate:.3g} N/m in all bounce at {{}}"
    yield _within(words, np.sqrt(rate / sprung) / (2.0 * np.pi), BOUNCE, "Hz")
    shares = 100.0 * found.share(vehicle.swing_arms.bump_travel)
    worst = shares.max() if shares.max() > TRAVEL_SHARE[1] else shares.min()
    words = "at rest a road wheel has gone {} of its way from the unloaded torsion bar to the bump stop"
    yield _within(words, worst, TRAVEL_SHARE, "%")
    yield f"at rest the hull stands {1e3 * found.sag:.0f} mm below static ride height", abs(found.sag) <= MOST_SAG
    pitch = np.degrees(found.pitch)
    yield f"at rest the hull is pitched by {pitch:.1f} deg, nose up", abs(pitch) <= HIGHEST_PITCH
    yield from _stiffnesses(vehicle, found, whole * GRAVITY / wheels, wheels)


def _stiffnesses(vehicle, found, load, wheels):
    """Judge stiffnesses by what gives under a wheel's load [N], and by the steps that they need."""
    for name, mount in vehicle.mounts.items():
        kind = vehicle.mount_types[mount.type]
        stiffness = kind.stiffness[2] if kind.kind == "rubber" else 1e6 * np.polyval(kind.stiffness_fit, found.current)
        if stiffness > 0.0:
            given = 1e3 * abs(found.mount[name][2]) / stiffness
            yield _within(f"mount {name} gives by {{}} under its load at rest", given, MOUNT_GIVES, "mm")
    v, percent = vehicle, 100.0
    tyre = percent * load / v.tyres.radial_stiffness / v.road_wheels.radius
    yield _within("under the weight tyres give by {} of the wheels' radius", tyre, TYRE_GIVES, "%")
    ground = 1e3 * load / (SHOES_UNDER_WHEEL * v.ground.stiffness)
    yield _within("the ground gives by {} under the weight", ground, GROUND_GIVES, "mm")
    link = percent * 0.5 * wheels * load / v.tracks.link_stiffness / v.tracks.pitch
    yield _within("a link that carries half of the weight stretches by {} of its pitch", link, LINK_STRETCHES, "%")
    (contact, frequency), rate = fastest_contact(vehicle), recommended_rate(vehicle)
    words = f"a pin {contact} vibrates at {frequency / (2.0 * np.pi):.0f} Hz, so that steps need {rate} Hz"
    yield f"{words}, usual: up to {HIGHEST_RATE} Hz", rate <= HIGHEST_RATE


def _within(words, value, accepted, unit):
    low, high = accepted
    return f"{words.format(f'{value:.3g} {unit}')}, usual: {span(low, high, unit)}", low <= value <= high
