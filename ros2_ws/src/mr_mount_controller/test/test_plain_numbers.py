"""Numbers and ranges in messages: as one writes them, and the same number when read again."""

import pytest
from mr_mount_controller.node_base.plain_text import number, span


@pytest.mark.property
@pytest.mark.parametrize(
    "value, words",
    [(0.1 + 0.2, "0.3"), (1e6, "1000000"), (-25.0, "-25"), (3, "3"), (2e12, "2e12"), (1e-8, "1e-8"), (0.0, "0"),
     (float("nan"), "nan")],
)  # fmt: skip
def test_numbers_are_written_plainly(value, words):
    """Without the digits that rounding leaves, and without a power of ten where none is needed."""
    assert number(value) == words
    assert value != value or float(number(value)) == pytest.approx(value, rel=1e-9)


@pytest.mark.property
def test_ranges():
    """With a unit or without one."""
    assert (span(0.1, 2.0, "m"), span(-1, 1e9)) == ("0.1 to 2 m", "-1 to 1000000000")
