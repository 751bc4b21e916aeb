"""The tables of the documents about messages: every field, with its unit and meaning, from the comments beside it."""

import re
from functools import partial
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / "ros2_ws" / "src" / "trackvib_msgs" / "msg"
LINE = re.compile(r"(?P<type>\S+)\s+(?P<name>\w+)(?:=(?P<value>\S+))?\s*(?:#\s*(?P<meaning>.*))?")


def message(name):
    """What a message holds: a row for each field, constant, and comment above them."""
    rows, told = [("field", "type", "meaning")], []
    for line in (FOLDER / f"{name}.msg").read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            told.append(line.removeprefix("#").strip())
        elif told:  # of the whole message, or of the fields below
            rows.append(("", "", " ".join(told)))
            told = []
        if not line.startswith("#") and (field := LINE.match(line)):
            value = f" = {field['value']}" if field["value"] else ""
            rows.append((f"`{field['name']}`{value}", f"`{field['type']}`", field["meaning"] or ""))
    return rows


TABLES = {f"message {path.stem}": partial(message, path.stem) for path in sorted(FOLDER.glob("*.msg"))}
