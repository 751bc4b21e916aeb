"""What every file keeps to: ruff's rules and format, and a reason at every slow test."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.property

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("command", [("check",), ("format", "--check")])
def test_ruff_finds_nothing(command):
    """The same rules as pre-commit's."""
    done = subprocess.run(
        [sys.executable, "-m", "ruff", *command, "--no-cache", "."], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def _slow_marks(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute) and ast.unparse(node) == "pytest.mark.slow":
            yield node


def _reasons(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "pytest.mark.slow":
            yield next((word.value.value for word in node.keywords if word.arg == "reason"), "")


def test_slow_tests_say_why():
    """Each mark has its reason."""
    files = [*ROOT.glob("tests/test_*.py"), *ROOT.glob("ros2_ws/src/*/test/**/test_*.py")]
    marks = {file: (len(list(_slow_marks(file))), list(_reasons(file))) for file in files}
    assert sum(count for count, _ in marks.values()) > 10
    for file, (count, reasons) in marks.items():
        assert len(reasons) == count and all(reasons), file
