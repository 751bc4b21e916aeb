"""The vehicle file: the shipped one loads, and what is wrong in another is said in words."""

from contextlib import suppress

import numpy as np
import pytest
import yaml
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.quantities import SOURCES
from trackvib_sim.vehicle.vehicle_file import VehicleFileError, parse_vehicle, read_vehicle


@pytest.fixture(scope="module")
def content():
    """The shipped file as text."""
    return find_vehicle().read_text(encoding="utf-8")


def refusal(text):
    """The message with which a text is refused."""
    with pytest.raises(VehicleFileError) as refused:
        parse_vehicle(text, "my.yaml")
    return str(refused.value)


@pytest.mark.property
def test_shipped_file_loads(content):
    """The shipped file is accepted, comes back with its text, and its values are those written in it."""
    vehicle, text = read_vehicle(find_vehicle())
    assert text == content
    assert len(list(_quantities(yaml.safe_load(content), vehicle))) > 100
    for value, written in _quantities(yaml.safe_load(content), vehicle):
        with suppress(ValueError):  # YAML takes 4.0e7 for a text, and some values are words
            written = np.array(written, dtype=float)
        assert np.array_equal(value, np.broadcast_to(written, np.shape(value)))


def _quantities(items, section):
    """Yield the value in a section of the vehicle and that which is written, for all quantities of a file."""
    for name, written in items.items():
        value = section[name] if isinstance(section, dict) else getattr(section, name)
        if not isinstance(written, dict):
            yield value, written
        elif "value" in written:
            yield value, written["value"]
        else:
            yield from _quantities(written, value)


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: &x [1, 2]\nb: *x", "my.yaml: not a YAML file: alias *x is not accepted, write the value out"),
        ("[" * 3000, "my.yaml: not a YAML file: nested too deeply, accepted: 50 levels"),
    ],
)
def test_texts_that_would_blow_up_are_refused(text, words):
    """In one sentence, before anything has grown."""
    assert refusal(text) == words


@pytest.mark.property
@pytest.mark.parametrize("name", ["leopard", "no/file.yaml", "x" * 300])
def test_who_names_no_file_hears_the_known_names(name):
    """A wrong name of a vehicle is a file that is not there: the names that are known are what helps."""
    with pytest.raises(VehicleFileError, match="cannot be read.*known by name are tao2025, .*m113"):
        read_vehicle(name)


@pytest.mark.literature
def test_published_values_are_the_papers(vehicle):
    """The fits, the rated load, the engine's speeds and its displacement are those printed in the paper."""
    m, e = vehicle.mount_types["mr"], vehicle.engine
    assert m.stiffness_fit == [0.0412, -0.581, 2.8317, 0.904]
    assert m.damping_ratio_fit == [0.0121, -0.1567, 0.6526, -0.3573]
    assert m.carried_mass == 1000.0
    assert (e.rated_speed, e.speed_range, e.imposed_amplitude) == (1650.0, [450.0, 2100.0], 2e-4)


MASS = "mass: {value: 9000.0, unit: kg, source: assumed}"
BAD = [
    (MASS, "", ("bodies.turret.mass is missing",)),
    (MASS, MASS + "\n    colour: {value: 1.0, unit: m, source: assumed}",
     ("bodies.turret.colour", "1.0", "unknown item; accepted: axis, ")),
    (MASS, MASS.replace("kg", "t"), ("bodies.turret.mass", "unit is 't'", "must be 'kg'")),
    (MASS, MASS.replace("assumed", "guessed"), ("bodies.turret.mass", "source is 'guessed'", ", ".join(SOURCES))),
    (MASS, MASS.replace("9000.0", "-1.0"), ("bodies.turret.mass is -1.0", "greater than 0")),
    (MASS, MASS.replace("9000.0", "0.0"), ("bodies.turret.mass is 0.0", "greater than 0")),
    (MASS, MASS.replace("9000.0", ".nan"), ("bodies.turret.mass is nan", "finite")),
    (MASS, MASS.replace("9000.0", ".inf"), ("bodies.turret.mass is inf", "finite")),
    (MASS, MASS.replace("9000.0", "1e+300"), ("bodies.turret.mass", "value is 1e300", "-1e12 to 1e12 kg")),
    ("centre: {value: [-0.15, 0.0, 0.35]", "centre: {value: [0, 2000.0, 0]",
     ("bodies.turret.centre", "2000", "-20 to 20 m")),
    (MASS, MASS.replace("9000.0", "heavy"), ("bodies.turret.mass is 'heavy'", "number")),
    (MASS, MASS.replace("9000.0", "true"), ("bodies.turret.mass", "value is True", "must be a number")),
    (MASS, MASS.replace("9000.0", "[1.0]"), ("bodies.turret.mass is [1.0]", "number")),
    (MASS, "mass: 9000.0", ("bodies.turret.mass", "must be written {value: ..., unit: kg, source: ...}")),
    (MASS, MASS.replace("source", "origin"), ("bodies.turret.mass", "must be written", "source: ...")),
    (MASS, MASS.replace("}", ", error: 5.0}"), ("bodies.turret.mass", "must be written", "optionally with a note")),
    ("centre: {value: [-0.15, 0.0, 0.35]", "centre: {value: [-0.15, 0.35]", ("bodies.turret.centre", "at least 3")),
    ("centre: {value: [-0.15, 0.0, 0.35]", "centre: {value: [0, .nan, 0]", ("bodies.turret.centre.1 is nan", "finite")),
    ("orders: {value: [2.0, 3.0, 6.0]", "orders: {value: [2.0, 3.0]", ("engine", "force has 3 rows", "each order")),
    ("current_range: {value: [0.7, 4.0]", "current_range: {value: [4.0, 0.7]",
     ("mount_types.mr", "current_range is [4, 0.7]", "first must be below")),
    ("current_limits: {value: [0.0, 5.0]", "current_limits: {value: [-1.0, 5.0]",
     ("coil.current_limits.0 is -1.0", "greater than or equal to 0")),
    ("model: {value: lag", "model: {value: fast", ("coil.model is 'fast'", "'lag' or 'current_loop'")),
    ("voltage_limits: {value: [-24.0, 24.0]", "voltage_limits: {value: [-24.0, 6.0]",
     ("coil: voltage_limits are [-24.0, 6.0] V", "must hold 0 to 10 V")),
    ("bump_travel: {value: 0.26", "bump_travel: {value: 0.5",
     ("swing_arms", "bump_travel is 0.5 m", "must be < 0.427")),
    ("damping: {value: [3.0e4, 3.0e4, 0, 0, 0, 3.0e4]", "damping: {value: [5.0e4, -1.0]",
     ("shock_absorbers.damping.1 is -1.0", "equal to 0")),
    ("damping: {value: [3.0e4, 3.0e4, 0, 0, 0, 3.0e4]", "damping: {value: [5.0e4, 0]",
     ("shock_absorbers.damping has 2 values", "one for each of 6 stations")),
    ("wheel_x: {value: [2.10, 1.28,", "wheel_x: {value: [2.10, 2.28,",
     ("swing_arms", "6 places, each behind the last")),
    ("shear_damping: {value: 4.0e3", "shear_damping: {value: 4.0e4",
     ("ground: shear_damping / shear_stiffness is 0.04 s, must be at most 0.02 s, or shear_stiffness 0",)),
    ("links: {value: 120,", "links: {value: 120.5,", ("tracks.links.0 is 120.5", "multiple of 1")),
    ("links: {value: 120,", "links: {value: 500,", ("tracks.links.0 is 500", "less than or equal to 250")),
    ("teeth: {value: 14,", "teeth: {value: 3,", ("sprocket_teeth.teeth is 3", "greater than or equal to 6")),
    ("x: {value: [1.95, 0.65, -0.65, -1.95]", "x: {value: [1.95, 0.65]", ("carrier_rollers", "2 places and z 4")),
    ("x: {value: -3.05", "x: {value: -2.0", ("sprockets.x is -2 m", "road wheels must lie between them")),
    ("parent: gun_mount", "parent: cupola", ("bodies.recoil_part: parent is 'cupola'", "hull, turret, gun_mount")),
    ("hinge: prismatic", "hinge: sliding", ("bodies.recoil_part", "'sliding'", "'prismatic'")),
    ("kind: mr", "kind: steel", ("mount_types.mr", "'steel'", "'mr', 'rubber'")),
    ("  left:\n    type: mr", "  left:\n    type: firm", ("mounts.left: type is 'firm'", "must be one of mr")),
    ("format: 3", "format: 4", ("format is 4", "should be 3")),
]  # fmt: skip


@pytest.mark.property
@pytest.mark.parametrize(("good", "bad", "words"), BAD)
def test_bad_items_are_named(content, good, bad, words):
    """One bad item in an otherwise good file is refused with file, item, value or unit and what is accepted."""
    assert content.count(good) == 1
    message = refusal(content.replace(good, bad))
    for word in ("my.yaml: ", *words):
        assert word in message
    assert len(message.splitlines()) == 1


@pytest.mark.property
def test_every_bad_item_is_named(content):
    """Two bad items give two lines."""
    text = content.replace("9000.0, unit: kg", "-1.0, unit: kg").replace('unit: "1/revolution"', "unit: Hz")
    lines = refusal(text).splitlines()
    assert len(lines) == 2
    assert "turret.mass" in lines[0] and "engine.orders" in lines[1]


@pytest.mark.property
@pytest.mark.parametrize("text", [
    "hull: [", "a: \x00", "a: !!python/object:x {}", "a: 2001-99-99", "a: b: c",
    "a: !!bool x", "a: !!int ''", "a: !!timestamp abc",
])  # fmt: skip
def test_no_yaml_is_said_so(text):
    """A text that YAML cannot read is refused as that."""
    assert "my.yaml: not a YAML file: " in refusal(text)


@pytest.mark.property
@pytest.mark.parametrize(("text", "value"), [("", "None"), ("text", "'text'"), ("[1, 2]", "[1, 2]")])
def test_yaml_of_another_kind_is_said_so(text, value):
    """YAML that is no table is refused with what it is and what is wanted."""
    assert refusal(text) == f"my.yaml: the whole file is {value}: must be a section with items"


@pytest.mark.property
def test_unreadable_files_are_named(tmp_path):
    """A path that is not there, a folder and a file that is no text are refused with their path."""
    binary = tmp_path / "binary.yaml"
    binary.write_bytes(b"\xff\xfe\x00mass")
    for path in (tmp_path / "none.yaml", tmp_path, binary):
        with pytest.raises(VehicleFileError, match="cannot be read") as refused:
            read_vehicle(path)
        assert repr(str(path)) in str(refused.value)


@pytest.mark.analytic
def test_a_file_of_format_2_is_read_as_it_was_meant(content, vehicle):
    """Damping, friction and stops along the wheel's arc: vertical ones are larger by the arm's angle, 25 degrees."""
    old = parse_vehicle(content.replace("format: 3", "format: 2"), "old.yaml")
    level = np.cos(np.radians(25.0))
    for section, powers in (
        ("swing_arms", {"friction": 2, "bump_stiffness": 2, "bump_damping": 2, "wheel_rate": 0}),
        ("shock_absorbers", {"damping": 2, "blow_off_force": 1, "blow_off_damping": 2}),
    ):
        for item, power in powers.items():
            was, now = (getattr(getattr(each, section), item) for each in (old, vehicle))
            assert was == pytest.approx([value / level**power for value in now], rel=1e-12)
    assert old.tracks == vehicle.tracks and old.format == vehicle.format
