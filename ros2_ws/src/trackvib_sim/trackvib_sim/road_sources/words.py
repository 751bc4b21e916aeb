"""What a road really is, in words: of a road file its ground and obstacles, and what the vehicle does before it."""

from collections import Counter

from mr_mount_controller.node_base.plain_text import number, span

from ..road.iso8608 import Iso8608Road
from ..road.obstacles import LevelRoad, ObstacleRoad
from ..road.profile import ProfileRoad

_NAMES = {"v_ramp": "V-ramp", "sine": "washboard"}


def composition(road):
    """Return what a road consists of, such as "class B of ISO 8608, with 1 half-round and 1 pothole"."""
    if isinstance(road, ObstacleRoad):
        counts = Counter(_NAMES.get(each.shape, each.shape.replace("_", "-")) for each in road.obstacles)
        found = ", ".join(f"{count} {name}{'s' if count > 1 else ''}" for name, count in counts.items())
        return f"{composition(road.ground)}, with {' and '.join(found.rsplit(', ', 1))}"
    if isinstance(road, Iso8608Road):
        own = road.roughness
        if isinstance(own, str):
            return f"class {own} of ISO 8608"
        return f"random, Gd(0.1 1/m) = {number(own.level)} m³, waviness {number(own.waviness)}"
    if isinstance(road, LevelRoad):
        return "level ground"
    if isinstance(road, ProfileRoad):
        how = [word for word, is_so in (("reversed", road.reverse), ("repeated", road.repeat)) if is_so]
        return " ".join(["a profile,", *how]).rstrip(",") if how else "a profile"
    return "the road of a recorded run"


def before(road):
    """Return in a sentence what a vehicle does before a road begins; nothing of one that begins with the run."""
    if not road.begins > 0.0:
        return ""
    ground = getattr(road, "ground", road)
    rolling = "a run starts at 0 m with the vehicle rolling steadily"
    if isinstance(ground, Iso8608Road):
        fades = span(ground.level_until, ground.begins, "m")
        return f"{rolling} on level ground; the roughness fades in from {fades}"
    return f"the road begins at {number(road.begins)} m; {rolling} on level ground up to there"
