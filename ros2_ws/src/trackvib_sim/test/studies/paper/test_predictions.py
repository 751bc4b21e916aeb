"""How well models foretell the paper's table, from tables made by hand; the vehicles calibrated without a class."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.data import find_vehicle, paper_table_file
from trackvib_sim.studies.case import GOOD
from trackvib_sim.studies.paper.paper_table import Row, read_table
from trackvib_sim.studies.paper.predictions import by_speed_alone, left_out_vehicles, ours
from trackvib_sim.vehicle.vehicle_file import parse_vehicle

SPEEDS, POWERS = (5.0, 10.0, 20.0), np.linspace(0.4, 0.9, 6)
SMOOTH = {(c, v): k * v**POWERS for c, k in (("A", 1.0), ("E", 1.44)) for v in SPEEDS}


def factors(paper):
    """What both models reach: fitted and left out, by number."""
    return [each[1:] for each in by_speed_alone(paper)]


@pytest.mark.analytic
def test_two_classes_a_factor_apart():
    """1.2**2 apart they leave 1.2 to both models, and 1.44 where each has to foretell the other."""
    assert_allclose(factors(SMOOTH), [(1.2, 1.44)] * 2, rtol=1e-12)


@pytest.mark.analytic
def test_a_jump_is_what_no_power_takes():
    """At the middle of speeds equally spaced in log(v) a straight line leaves 0.3 * (-1, 2, -1) / 3."""
    jump = dict(zip(SPEEDS, np.exp([0.0, 0.3, 0.0]), strict=True))
    bent = {(c, v): levels * jump[v] for (c, v), levels in SMOOTH.items()}
    rest = 0.3 * np.sqrt(2.0) / 3.0
    power = np.exp(np.hypot(np.log(1.2), rest)), np.exp(np.hypot(np.log(1.44), rest))
    assert_allclose(factors(bent), [(1.2, 1.44), power], rtol=1e-12)


@pytest.mark.analytic
def test_one_class_foretells_nothing():
    """Without another class, and where the others lack a speed, there is no prediction."""
    alone = {key: values for key, values in SMOOTH.items() if key[0] == "A"}
    assert np.isnan([left_out for _, left_out in factors(alone)]).all()
    lacking = {key: values for key, values in SMOOTH.items() if key != ("E", 20.0)}
    (_, by_mean), (_, by_power) = factors(lacking)
    assert np.isnan(by_mean) and np.isfinite(by_power)


@pytest.mark.analytic
def test_ours_are_those_of_the_rows():
    """Twice the table by the vehicle, four times by those that did not know the class."""
    rows = [[Row(c, v, k * levels, np.zeros(6), np.ones(3), GOOD) for (c, v), levels in SMOOTH.items()] for k in (2, 4)]
    assert_allclose(ours(*rows, SMOOTH)[1:], (2.0, 4.0))
    assert np.isnan(ours(rows[0], [], SMOOTH).left_out)


@pytest.mark.property
def test_every_class_of_the_paper_has_a_vehicle_calibrated_without_it():
    """They differ from the default vehicle and each other; of a vehicle changed by a user there is none."""
    text, paper = find_vehicle().read_text(encoding="utf-8"), read_table(paper_table_file())
    found = left_out_vehicles(text, paper)
    assert set(found) == {road_class for road_class, _ in paper}
    assert len({text, *found.values()}) == 1 + len(found)
    for road_class, other in found.items():
        parse_vehicle(other, road_class)
    assert left_out_vehicles(text.replace("name: tao2025", "name: mine"), paper) == {}
