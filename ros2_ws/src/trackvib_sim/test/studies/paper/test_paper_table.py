"""The paper's table and ours: how they are read, written and compared."""

import csv

import numpy as np
import pytest
from hypothesis import given as holds_for
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from trackvib_sim.data import paper_table_file
from trackvib_sim.studies.case import Case, Result
from trackvib_sim.studies.paper.paper_table import (
    COLUMNS,
    column_bias,
    error_factor,
    given,
    read_table,
    reduction,
    table_csv,
    table_rows,
)

PAPER = read_table(paper_table_file())
LEVEL = st.floats(1e-3, 1e3)


def good(scale):
    """A result whose levels are 1, 2, ... 9 times `scale`, probe by probe and ROS axis by axis."""
    chassis, powertrain, rigid = (tuple(scale * (first + k) for k in range(3)) for first in (1, 4, 7))
    return Result("ok", {"chassis": chassis, "powertrain": powertrain, "rigid": rigid}, 10.0)


def failed(reason):
    """A result of a run that left the valid range."""
    return Result(f"failed: {reason}", {}, None)


def rows_of(road_class, speed, *results):
    """The rows of one class and speed with a result a seed."""
    return table_rows({Case(road_class, speed, seed, 0.5): result for seed, result in enumerate(results)})


@pytest.mark.literature
def test_given_part_of_the_papers_table():
    """Classes A, C, E at three speeds are given; the reductions at E, 20 m/s are those that the paper's prose names."""
    assert sorted(PAPER) == [(road_class, speed) for road_class in "ACE" for speed in (5.0, 10.0, 20.0)]
    longitudinal, vertical, lateral = reduction(PAPER["E", 20.0])
    assert (longitudinal, vertical, lateral) == pytest.approx((-14.25, 41.63, 23.8), abs=0.005)


@pytest.mark.analytic
def test_error_factor_by_hand():
    """Off by 2 up, by 2 down and by nothing: sqrt((ln2^2 + ln2^2 + 0) / 3) = 0.56595, whose exponential is 1.76113."""
    assert error_factor(np.array([2.0, 3.0, 7.0]), np.array([1.0, 6.0, 7.0])) == pytest.approx(1.76113, abs=1e-5)


@pytest.mark.property
@holds_for(level=LEVEL, other=LEVEL, factor=st.floats(1.0, 1e3))
def test_error_factor_is_the_same_up_and_down(level, other, factor):
    """Everything off by one factor, up or down, gives that factor; two values never less than 1."""
    values = np.array([level, other])
    assert error_factor(factor * values, values) == pytest.approx(factor)
    assert error_factor(values / factor, values) == pytest.approx(factor)
    assert error_factor(np.array([level]), np.array([other])) >= 1.0


@pytest.mark.property
@holds_for(level=LEVEL, bias=st.lists(st.floats(0.1, 10.0), min_size=6, max_size=6), spread=st.floats(1.0, 5.0))
def test_bias_of_a_column_is_what_its_rows_share(level, bias, spread):
    """Rows that scatter evenly about a factor have that factor as bias; columns do not mix."""
    paper = np.full((2, 6), level)
    assert_allclose(column_bias(paper * bias * [[spread], [1.0 / spread]], paper), bias, rtol=1e-9)


@pytest.mark.analytic
def test_rows_are_means_over_seeds_in_the_papers_axes():
    """Levels 1, 2, 3 times 1 and 3: mean 2, deviation sqrt(2) of two; the paper's second axis is vertical, ROS z."""
    (row,) = rows_of("C", 10.0, good(1.0), good(3.0))
    assert (row.road_class, row.speed, row.status) == ("C", 10.0, "ok")
    assert_allclose(row.rms, [2.0, 6.0, 4.0, 8.0, 12.0, 10.0])
    assert_allclose(row.scatter, np.sqrt(2.0) * np.array([1.0, 3.0, 2.0, 4.0, 6.0, 5.0]))
    assert_allclose(row.rigid, [14.0, 18.0, 16.0])
    assert_allclose(reduction(row.rms), [-300.0, -100.0, -150.0])
    assert_allclose(reduction(row.rms, row.rigid), [-600.0, -200.0, -300.0])


@pytest.mark.property
def test_runs_outside_the_valid_range_are_named_and_left_out():
    """Means are those of the good runs; the status counts the others and gives each reason once."""
    (partly,) = rows_of("H", 10.0, failed("it fell"), good(2.0), failed("it fell"))
    assert partly.status == "2 of 3 outside the valid range: it fell"
    assert_allclose(partly.rms, 2.0 * np.array([1, 3, 2, 4, 6, 5]))
    (none,) = rows_of("H", 20.0, failed("it fell"), failed("it flew"))
    assert none.status == "outside the valid range: it fell; it flew"
    assert np.isnan(none.rms).all() and np.isnan(none.scatter).all() and np.isnan(none.rigid).all()


@pytest.mark.property
def test_rows_stand_in_order_of_class_and_speed():
    """However cases come in, 5 m/s stands before 10 and 20."""
    found = {Case(road_class, speed, 1, 0.0): good(1.0) for road_class in "CA" for speed in (20.0, 5.0, 10.0)}
    keys = [(row.road_class, row.speed) for row in table_rows(found)]
    assert keys == [(road_class, speed) for road_class in "AC" for speed in (5.0, 10.0, 20.0)]


@pytest.mark.property
def test_written_table_is_read_like_the_papers(tmp_path):
    """Our file leads with the paper's columns; values come back to six digits, failed rows are empty."""
    rows = rows_of("A", 5.0, good(np.pi)) + rows_of("H", 20.0, failed("it fell, and fell"))
    (tmp_path / "ours.csv").write_text(table_csv(rows))
    theirs = [line for line in paper_table_file().read_text().splitlines() if not line.startswith("#")][0].split(",")
    with (tmp_path / "ours.csv").open(newline="") as file:
        header, first, second = csv.reader(file)
    assert header == [*theirs, "status", *(f"{name}_std" for name in COLUMNS)]
    assert first[8] == "ok" and first[9:] == [""] * 6  # of one run there is no deviation
    assert second == ["H", "20", *[""] * 6, rows[1].status, *[""] * 6]
    back = read_table(tmp_path / "ours.csv")
    assert list(back) == [("A", 5.0), ("H", 20.0)]
    assert_allclose(back["A", 5.0], rows[0].rms, rtol=1e-5)
    assert np.isnan(back["H", 20.0]).all()


@pytest.mark.property
def test_only_rows_that_both_have_are_compared():
    """Classes that the paper's part lacks and failed rows do not enter."""
    rows = rows_of("A", 5.0, good(1.0)) + rows_of("B", 5.0, good(1.0)) + rows_of("E", 20.0, failed("it fell"))
    ours, paper = given(rows, PAPER)
    assert_array_equal(ours, [rows[0].rms])
    assert_array_equal(paper, [PAPER["A", 5.0]])
    assert given(rows[1:], PAPER).shape == (2, 0, 6)
