"""Labels in pictures do not touch one another, however many lines there are: measured in the picture itself."""

from itertools import combinations, pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from trackvib_sim.analysis.labels import Box, first_free, joined
from trackvib_sim.analysis.numbers import Line
from trackvib_sim.analysis.plots import mark_lines


def line(name, lowest, highest=None):
    """Return a line at a frequency, or one that moved over a range."""
    highest = highest or lowest
    return Line(name, 0.5 * (lowest + highest), lowest, highest, lowest - 2.0, highest + 2.0, {})


@pytest.mark.property
def test_groups_hold_every_line_once_and_have_room():
    """Whatever the places, each label begins a width beyond the one before it."""
    random = np.random.default_rng(4)
    for count in (0, 1, 2, 30):
        places = random.uniform(0.0, 3.0, count)
        groups = joined(places, 0.1)
        assert sorted(index for group in groups for index in group) == list(range(count))
        first = [places[group[0]] for group in groups]
        assert all(later - earlier >= 0.1 for earlier, later in pairwise(first))


@pytest.mark.property
def test_boxes_that_touch_are_passed_over():
    """The first free one is taken; where none is free, none."""
    taken = [Box(0.0, 0.0, 1.0, 1.0)]
    assert first_free([Box(0.5, 0.5, 2.0, 2.0), Box(1.0, 0.0, 2.0, 1.0)], taken) == Box(1.0, 0.0, 2.0, 1.0)
    assert first_free([Box(-1.0, -1.0, 2.0, 2.0)], taken) is None


STEADY = [line(f"link passing {n}", 72.4 * n) for n in (1, 2, 3)] + [line("engine order 2", 73.3)]
MANY = STEADY + [line(f"engine order {0.5 * n:g}", 13.75 * n) for n in range(1, 25)]
SWEPT = [line(f"link passing {n}", 34.0 * n, 53.0 * n) for n in (1, 2, 3)] + MANY[3:6]


@pytest.mark.property
@pytest.mark.parametrize("lines", [STEADY, MANY, SWEPT, []], ids=["steady", "many", "swept", "none"])
def test_no_label_of_a_picture_covers_another(lines):
    """As drawn, in pixels of a figure as large as run.png; every line is named."""
    figure = Figure(figsize=(13, 5.4), layout="constrained")
    canvas, plot = FigureCanvasAgg(figure), figure.subplots()
    plot.set_xscale("log")
    plot.set_xlim(1.0, 500.0)
    mark_lines(plot, lines)
    canvas.draw()
    frame = plot.get_window_extent()
    boxes = [text.get_window_extent() for text in plot.texts]
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert all(frame.y0 <= box.y0 and box.y1 <= frame.y1 for box in boxes)
    named = ", ".join(text.get_text() for text in plot.texts)
    assert all(f"{each.name}: {each.hertz} Hz" in named for each in lines)
