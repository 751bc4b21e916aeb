"""Both packages as a library, installed with pip in an environment of its own, without ROS 2 and without extras."""

import os
import shutil
import subprocess
import sys
from hashlib import sha1
from pathlib import Path

import numba
import pytest
import trackvib_sim

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="installs the library with pip")]

SOURCES = Path(__file__).parents[1] / "ros2_ws" / "src"
PACKAGES = ("mr_mount_controller", "trackvib_sim")
# What pip itself needs to know of the machine; nothing of ROS and nothing of this environment.
KEPT = ("HOME", "PATH", "TMPDIR", "LANG")

CLOSED_LOOP = """
import sys
import trackvib_sim as tv
from mr_mount_controller.laws import find_law

vehicle, _ = tv.read_vehicle(tv.find_vehicle())
rates = tv.Rates(tv.recommended_rate(vehicle))
settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), rates, passive_current=1.0)
record = tv.run_closed_loop(tv.Simulation(vehicle, settings), tv.Iso8608Road("E", 1), find_law("skyhook")(1e-3), 200)
print(record.specific_force.shape)
analysis = tv.analyse(tv.read_recording(sys.argv[1]))
print(analysis.sensors["powertrain"]["z"].rms > 0.0)
print(sorted(name for name in ("rclpy", "matplotlib", "click") if name in sys.modules))
"""
WITHOUT_EXTRA = "import trackvib_sim.studies.case"


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    """A function that runs Python in the new environment: `bare(arguments)`."""
    folder = tmp_path_factory.mktemp("bare environment")
    for package in PACKAGES:  # pip builds beside the sources
        shutil.copytree(
            SOURCES / package, folder / package, ignore=shutil.ignore_patterns("build", "*.egg-info", "test")
        )
    environment = {name: os.environ[name] for name in KEPT if name in os.environ} | {
        name: value for name, value in os.environ.items() if name.startswith("PIP_") or name.lower().endswith("_proxy")
    }
    environment["NUMBA_CACHE_DIR"] = str(folder / "kernels")
    base = Path(sys.base_prefix) / "bin" / f"python3.{sys.version_info.minor}"
    python = folder / "venv" / "bin" / "python"

    def run(*arguments):
        return subprocess.run(
            [python, *arguments], env=environment, cwd=folder, capture_output=True, text=True, timeout=600
        )

    made = subprocess.run([base, "-m", "venv", folder / "venv"], env=environment, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    packages = (f"numba=={numba.__version__}", *(f"./{package}" for package in PACKAGES))
    done = run("-m", "pip", "install", "--no-compile", *packages)
    assert done.returncode == 0, done.stdout + done.stderr
    installed = run("-c", "import trackvib_sim; print(trackvib_sim.__path__[0])").stdout.strip()
    share_kernels(Path(trackvib_sim.__file__).parent, Path(installed), folder / "kernels")
    return run


def share_kernels(compiled, installed, folder):
    """Copy to `folder` the kernels of the same sources that the set-up has compiled, under the other package's path.

    Compiling them again would take most of the test's time. numba names a cache by its sources' folder.
    """

    def name(room):
        return f"{room.name}_{sha1(str(room).encode()).hexdigest()}"

    rooms = [path for path in (compiled, *compiled.rglob("*")) if path.is_dir()]
    for room in rooms:
        kernels = Path(numba.config.CACHE_DIR) / name(room)
        if kernels.is_dir():
            shutil.copytree(kernels, folder / name(installed / room.relative_to(compiled)))
    assert any(folder.iterdir())


def test_drives_and_measures(bare, recorded_run):
    """A closed loop in process and the analysis of a bag; nothing of ROS and of no extra is imported."""
    done = bare("-c", CLOSED_LOOP, str(recorded_run / "bag"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["(200, 2, 3)", "True", "[]"]


def test_what_needs_an_extra_says_which(bare):
    """One line, no traceback of a module that nobody knows."""
    done = bare("-c", WITHOUT_EXTRA)
    assert done.returncode != 0
    assert 'pip install "trackvib_sim[studies]"' in done.stderr
