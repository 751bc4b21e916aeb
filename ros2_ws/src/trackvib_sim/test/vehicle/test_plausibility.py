"""Slips of the pen in a vehicle file: what is impossible is refused, what is implausible is told in a sentence."""

import pytest
import yaml
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.vehicle.plausibility import doubts
from trackvib_sim.vehicle.standing import standing
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import VehicleFileError, parse_vehicle, read_vehicle

pytestmark = pytest.mark.property


def scaled(value, factor):
    """Return a number or a list of them times a factor; YAML reads 3.4e5 as text."""
    return [float(each) * factor for each in value] if isinstance(value, list) else float(value) * factor


def changed(path, factor):
    """Return the text of the default vehicle with one quantity scaled."""
    content = yaml.safe_load(find_vehicle().read_text(encoding="utf-8"))
    *sections, item = path.split(".")
    section = content
    for name in sections:
        section = section[name]
    section[item]["value"] = scaled(section[item]["value"], factor)
    return yaml.safe_dump(content, sort_keys=False)


@pytest.mark.parametrize("name", vehicle_names())
def test_the_vehicles_included_are_plausible(name):
    """Nothing is doubted."""
    assert doubts(read_vehicle(find_vehicle(name))[0]) == []


@pytest.mark.parametrize(
    ("path", "factor", "words"),
    [
        ("hull.mass", 8.5 / 18000.0, "hull: mass is 8.5 kg .* a radius of gyration of 102 m, must be at most 5.85 m"),
        ("powertrain.mass", 1e-3, "powertrain: mass is 3.2 kg"),
        ("hull.inertia", 1e3, "radius of gyration"),
        ("tracks.pitch", 1e3, "tracks.pitch is 115.0: .* less than or equal to 0.5"),
        ("road_wheels.y", 1e3, "value is 1400, must be from -20 to 20 m"),
        ("sprockets.x", 1e3, "value is -3050, must be from -20 to 20 m"),
    ],
)
def test_impossible_vehicles_are_refused(path, factor, words):
    """With item, value and what is accepted."""
    with pytest.raises(VehicleFileError, match=words):
        parse_vehicle(changed(path, factor), "my.yaml")


def test_moments_of_inertia_that_no_body_has_are_refused():
    """A plate reaches the triangle inequality; beyond it, and with products too great, there is no vehicle to stand."""
    text = find_vehicle().read_text(encoding="utf-8")
    good = "value: [20000.0, 75000.0, 88000.0]"
    assert text.count(good) == 1
    doubts(parse_vehicle(text.replace(good, "value: [20000.0, 70000.0, 89900.0]"), "my.yaml"))
    for bad in ("value: [20000.0, 70000.0, 93000.0]", "value: [20.0, 75.0, 88.0]"):
        with pytest.raises(ValueError, match=r"\(hull\): principal moments .* the sum of the other two"):
            doubts(parse_vehicle(text.replace(good, bad), "my.yaml"))


@pytest.mark.parametrize(
    ("path", "factor", "words"),
    [
        ("swing_arms.wheel_rate", 1e3, "bounce at 55.5 Hz, usual: 0.6 to 6 Hz"),
        ("swing_arms.wheel_rate", 1e-3, "usual: 2 to 80 %"),
        ("swing_arms.bump_travel", 1e-2, "from the unloaded torsion bar to the bump stop"),
        ("tyres.radial_stiffness", 1e3, "tyres give by"),
        ("ground.stiffness", 1e-3, "the ground gives by 1.46e"),
        ("tracks.link_stiffness", 1e-3, "stretches by"),
        ("tracks.link_stiffness", 1e3, "steps need"),
        ("mount_types.mr.stiffness_fit", 1e3, "mount left gives by 0.00235 mm"),
    ],
)
def test_implausible_vehicles_are_doubted(path, factor, words):
    """In sentences that name the quantity and what is usual."""
    found = doubts(parse_vehicle(changed(path, factor), "my.yaml"))
    assert any(words in sentence for sentence in found), found


def test_a_hull_too_light_for_its_suspension_is_doubted():
    """One of 8.5 kg whose moments of inertia fit its mass."""
    text = changed("hull.mass", 8.5 / 18000.0).replace("20000.0", "8.0").replace("75000.0", "30.0")
    found = doubts(parse_vehicle(text.replace("88000.0", "35.0").replace("-800.0", "0.0"), "my.yaml"))
    assert any("hull.mass is 8.5 kg" in sentence for sentence in found)


def test_a_hull_whose_weight_lies_ahead_is_doubted():
    """It stands nose down."""
    text = find_vehicle().read_text(encoding="utf-8").replace("[-0.2, 0.0, 1.06]", "[2.0, 0.0, 1.06]")
    assert any("the hull is pitched by -3.4 deg" in each for each in doubts(parse_vehicle(text, "my.yaml")))


def test_shares_of_the_travel_add_up():
    """Deflection of the bars times the wheel rate is the weight of what is sprung and what the tracks pull down."""
    vehicle, _ = read_vehicle(find_vehicle())
    supports = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4).supports
    pull = supports.upper_weight.sum() - supports.pull[:, :, 1].sum()
    found = standing(vehicle)
    carried = (found.deflection * vehicle.swing_arms.wheel_rate[0]).sum()
    assert carried == pytest.approx(9.81 * 33_500.0 + pull, rel=0.05)
    share = found.share(vehicle.swing_arms.bump_travel)
    assert share.shape == (2, 6) and (share > 0.25).all() and (share < 0.4).all()
    assert abs(found.sag) < 0.03 and abs(found.pitch) < 0.01
