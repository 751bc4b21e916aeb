"""The resistance study: what drives is found again as heat, and the table says so."""

import csv
from io import StringIO

import pytest
from matplotlib.image import imread
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.studies.resistance.case import ResistanceCase, ResistanceResult, pull, roll
from trackvib_sim.studies.resistance.picture import resistance_picture
from trackvib_sim.studies.resistance.table import FORMULAS, SINKS, force, published, table_csv
from trackvib_sim.vehicle.body_tree import whole_mass

FAST = ResistanceCase(12.0)


@pytest.fixture(scope="module")
def rolled(vehicle):
    """The shipped vehicle's result."""
    return roll(vehicle, FAST)


@pytest.mark.slow(reason="rolls the vehicle for seconds")
@pytest.mark.property
def test_work_of_the_drive_is_found_again(rolled):
    """To 2 % as heat of one part or another, none of which gives any; the speed is held."""
    assert rolled.status == "ok" and rolled.speed == pytest.approx(12.0, rel=0.01)
    assert list(rolled.heat) == list(SINKS) and min(rolled.heat.values()) >= 0.0
    assert abs(rolled.left_over) < 0.02
    assert sum(rolled.heat.values()) == pytest.approx(rolled.drive, rel=0.1)
    assert rolled.drive > 1e5


@pytest.mark.cross_engine
def test_force_without_the_account_is_the_same(vehicle, rolled, simulation, level):
    """The work that a run books by the way, over the same second and from the start on, to the scatter of one: 3 %."""
    assert pull(vehicle, FAST) == pytest.approx(force(rolled), rel=0.03)
    moving = simulation(FAST.speed)
    run_open_loop(moving, level, 3000)
    work, way = moving.state.drive.driving.done
    assert way == pytest.approx(FAST.speed * 3.0, rel=0.01)
    assert work / way == pytest.approx(force(rolled), rel=0.03)


@pytest.mark.slow(reason="rolls each vehicle for seconds")
@pytest.mark.property
def test_dry_bearings_take_force_and_oil_does_not(vehicle, rolled, changed):
    """Without viscous friction of the pins the pins take nothing; the vehicle rolls easier."""
    easy = roll(changed("tracks", pin_damping=0.0), FAST)
    assert force(easy) < force(rolled)
    assert easy.heat["links"] < rolled.heat["links"]


@pytest.mark.analytic
def test_formulas_by_hand(vehicle):
    """At 10 m/s, 36 km/h: 330 and 223 N per tonne; without its shoes the vehicle has 38.02 t."""
    shoes = 240.0 * vehicle.tracks.shoe_mass
    assert whole_mass(vehicle) == pytest.approx(38_020.0 + shoes, rel=1e-3)
    assert list(published(1000.0, 10.0).values()) == pytest.approx([330.0, 223.0])


@pytest.mark.property
def test_table_and_picture(rolled, tmp_path):
    """A row for each speed, failed ones with their reason; forces in N."""
    failed = ResistanceResult("failed: it fell", None, None, {}, None)
    found = {FAST: rolled, ResistanceCase(25.0): failed}
    one, two = csv.DictReader(StringIO(table_csv(found, 42_130.0)))
    assert float(one["force, N"]) == pytest.approx(force(rolled), rel=1e-4)
    assert float(one["power, W"]) == pytest.approx(rolled.drive, rel=1e-4) and one["status"] == "ok"
    assert (
        two["force, N"] == "" and two["status"] == "failed: it fell" and float(two[f"formula {[*FORMULAS][0]}, N"]) > 0
    )
    resistance_picture(found, 42_130.0, "made up", tmp_path / "picture.png")
    assert imread(tmp_path / "picture.png").shape[2] == 4
