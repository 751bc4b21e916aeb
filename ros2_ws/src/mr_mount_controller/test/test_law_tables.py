"""docs/controllers.md says what the laws' classes say."""

from pathlib import Path

import pytest
from mr_mount_controller.law_tables import renewed, shipped_laws, table
from mr_mount_controller.laws import find_law

DOCUMENT = Path(__file__).parents[4] / "docs" / "controllers.md"
MARKS = "<!-- parameters -->\nold\n<!-- /parameters -->\n"


@pytest.mark.property
def test_document_is_up_to_date():
    """Its table is that of the laws; `python -m mr_mount_controller.law_tables docs/controllers.md` renews it."""
    document = DOCUMENT.read_text(encoding="utf-8")
    assert renewed(document) == document


@pytest.mark.property
@pytest.mark.parametrize("name", shipped_laws())
def test_every_parameter_has_its_row(name):
    """Name, default, both ends of the range, unit and meaning of each parameter stand in the law's part."""
    law, rows = find_law(name), table([name]).splitlines()[2:]
    assert rows[0].startswith(f"| **{name}** |")
    assert len(rows) == 1 + len(law.parameters) >= 2
    for parameter, row in zip(law.parameters, rows[1:], strict=True):
        assert row == (
            f"| `{parameter.name}` | `{parameter.default}` "
            f"| {parameter.low:g} to {parameter.high:g} {parameter.unit}".rstrip()
            + f" | {parameter.description} |"
        )


@pytest.mark.property
def test_only_the_table_changes():
    """What stands around the marks stays."""
    document = renewed(f"before\n{MARKS}after\n")
    assert document.startswith("before\n<!-- parameters -->\n| parameter |")
    assert document.endswith("<!-- /parameters -->\nafter\n") and "\nold\n" not in document


@pytest.mark.property
def test_missing_marks_are_named():
    """A document without the place for the table is refused with the mark that is missing."""
    with pytest.raises(ValueError, match="<!-- parameters -->.* stands 0 times, must be once"):
        renewed(MARKS.replace("<!-- /parameters -->", ""))
