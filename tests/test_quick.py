"""What `./trackvib test --quick` leaves: a test in every room, and each kind of thing done once with real processes."""

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.property

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "ros2_ws" / "src" / "trackvib_sim"
# the loop over DDS with its bag, an analysis, a study
REAL = (
    "tests/test_replay_verify.py::test_a_recorded_run_comes_out_again",
    "tests/test_analyze.py::test_brackets_in_a_path_are_printed",
    "tests/test_studies.py::test_leaves_table_report_and_picture",
)


@pytest.fixture(scope="module")
def quick():
    """The quick tests, as pytest names them."""
    command = [sys.executable, "-m", "pytest", "-m", "not slow", "--collect-only", "-q", "-n", "0", "--assert=plain"]
    done = subprocess.run(
        [*command, "tests", *sorted(ROOT.glob("ros2_ws/src/*/test"))], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return [line for line in done.stdout.splitlines() if "::" in line]


@pytest.mark.slow(reason="collects every test in a process of its own")
def test_every_room_has_a_quick_test(quick):
    """Each folder of sources has its folder of tests, and not all of these are slow."""
    sources = (PACKAGE / "trackvib_sim").rglob("*.py")
    rooms = {file.parent.relative_to(PACKAGE / "trackvib_sim") for file in sources if file.name != "__init__.py"}
    assert len(rooms) > 15
    tested = {(ROOT / name.split("::")[0]).parent for name in quick}
    assert {room for room in rooms if PACKAGE / "test" / room not in tested} == set()
    assert ROOT / "ros2_ws" / "src" / "mr_mount_controller" / "test" in tested


@pytest.mark.slow(reason="the same collection")
@pytest.mark.parametrize("name", REAL)
def test_what_is_real_is_done_once(quick, name):
    """With real processes, real DDS and real files."""
    assert any(line.startswith(name) for line in quick)
