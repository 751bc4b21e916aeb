"""`trackvib fmu`: FMPy, in an environment of its own, runs what it writes; the bits are those of the simulation."""

import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.simulator_parameters import PARAMETERS, simulation_of
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.road_sources.road_file import find_road
from trackvib_sim.simulation.readings import Readings
from trackvib_sim.simulation.simulation import HORIZON
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .processes import trackvib

pytestmark = pytest.mark.system

SPEED, SEED, STEPS, LONG = 7.0, 4, 60, 3  # the last step is of so many periods
# what FMPy needs and the locked environment has not; the rest it takes from there
FMPY = ("fmpy==0.3.32", "attrs", "lark", "lxml")
KEPT = ("HOME", "PATH", "TMPDIR", "LANG")

# Prints nothing of its own on stdout but what is asked for; drives two instances, the second one by half.
RUN = """
import faulthandler
import sys
import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu

faulthandler.enable()
file, target, steps, long = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
assert validate_fmu(file) == []
description = read_model_description(file)
folder = extract(file)
number = {each.name: each.valueReference for each in description.modelVariables}
told = [number[f"{end}.linear_acceleration.{axis}"] for end in ("chassis", "powertrain") for axis in "xyz"]
told += [number[name] for name in sorted(number) if name.startswith("mount_state.")]
coils = [number[name] for name in number if name.startswith("coil_current.")]

def begin(name):
    one = FMU2Slave(guid=description.guid, unzipDirectory=folder, instanceName=name,
                    modelIdentifier=description.coSimulation.modelIdentifier)
    one.instantiate()
    one.setupExperiment(startTime=0.0)
    one.enterInitializationMode()
    one.exitInitializationMode()
    return one

one, other = begin("one"), begin("other")
rows = []
for k in range(steps):
    one.setReal(coils, [1.0 + 0.03 * k, 3.0 - 0.02 * k])
    one.doStep(0.001 * k, 0.001)
    rows.append(one.getReal(told))
    if k % 2:
        other.doStep(0.0005 * k, 0.001)
one.doStep(0.001 * steps, 0.001 * long)
rows.append(one.getReal(told))
np.save(target, rows)
try:
    one.doStep(0.001 * (steps + long), 0.0004)
except Exception:
    print("refused")
for each in (one, other):
    each.terminate()
    each.freeInstance()
print([variable.name for variable in description.modelVariables if variable.causality == "input"])
"""


@pytest.fixture(scope="module")
def fmpy(tmp_path_factory):
    """A function that runs a script in an environment with FMPy and without trackvib."""
    folder = tmp_path_factory.mktemp("fmpy")
    environment = {name: value for name, value in os.environ.items() if name in KEPT or name.startswith("PIP_")}
    base = Path(sys.base_prefix) / "bin" / f"python3.{sys.version_info.minor}"
    subprocess.run([base, "-m", "venv", folder / "venv"], env=environment, check=True, capture_output=True)
    python = folder / "venv" / "bin" / "python"
    done = subprocess.run(
        [python, "-m", "pip", "install", "--no-deps", *FMPY], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    (packages,) = (folder / "venv" / "lib").glob("*/site-packages")
    (packages / "locked.pth").write_text(sysconfig.get_path("purelib"))

    def run(script, *arguments):
        command = [python, "-c", script, *map(str, arguments)]
        return subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, timeout=600)

    return run


def in_process():
    """What sensors and mounts tell under the same currents, (steps + 1, values), as `RUN` has it."""
    vehicle, _ = read_vehicle(find_vehicle())
    values = {parameter.name: parameter.default for parameter in PARAMETERS} | {"speed": SPEED}
    simulation, readings = simulation_of(vehicle, values, ""), None
    feeder = RoadFeeder(find_road("D", 2.0 * vehicle.road_wheels.y, SEED), HORIZON)
    readings, rows = Readings(simulation), []
    names = sorted(
        (f"mount_state.{name}.{quantity}" + ("" if array.ndim == 1 else f".{axis}"), quantity, i, axis)
        for quantity, array in simulation.sample.mounts._asdict().items()
        for i, name in enumerate(simulation.mounting.names[: len(array)])
        for axis in ("xyz" if array.ndim == 2 else "x")
    )
    for k in range(STEPS + LONG):
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        k = min(k, STEPS - 1)
        simulation.advance([1.0 + 0.03 * k, 3.0 - 0.02 * k])
        read = readings.take()
        row = [*read["chassis"].specific_force, *read["powertrain"].specific_force]
        for _, quantity, i, axis in names:
            value = getattr(simulation.sample.mounts, quantity)[i]
            row.append(value["xyz".index(axis)] if np.ndim(value) else value)
        rows.append(row)
    return np.array(rows[:STEPS] + rows[-1:])


@pytest.mark.slow(reason="installs FMPy with pip")
def test_fmpy_drives_it_as_the_process_does(fmpy, tmp_path):
    """Accelerations and mounts are bit-identical beside a second instance; an odd step is refused."""
    file = tmp_path / "made.fmu"
    printed = trackvib("fmu", "--road", "D", "--speed", SPEED, "--seed", SEED, "--out", file)
    assert "2 inputs" in printed and f"Python {sys.version_info[0]}.{sys.version_info[1]}" in printed
    done = fmpy(RUN, file, tmp_path / "rows.npy", STEPS, LONG)
    assert done.returncode == 0, done.stdout + done.stderr
    names = [f"coil_current.{name}" for name in ("left", "right")]
    assert done.stdout.splitlines()[-2:] == ["refused", str(names)]
    np.testing.assert_array_equal(np.load(tmp_path / "rows.npy"), in_process())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--out", "vehicle.zip"], "--out is 'vehicle.zip', must end in .fmu"),
        (["--out", "nowhere/vehicle.fmu"], "cannot be written"),
        (["--road", "Z"], "accepted: a class"),
        (["--vehicle", "nobody"], "vehicles known by name are"),
        (["--speed", "99"], "is not in the range"),
        (["--physics-rate", "1500"], "conflict"),
        (["--gears", "--vehicle", "m113"], "gears"),
    ],
)
def test_what_cannot_be_exported_leaves_nothing(tmp_path, options, words):
    """One clear error; a file that was there is as it was, and nothing is beside it."""
    (tmp_path / "trackvib.fmu").write_text("mine")
    printed = trackvib("fmu", *options, code=2 if "--speed" in options else 1, cwd=tmp_path)
    assert words in printed and "Traceback" not in printed, printed
    assert [path.name for path in tmp_path.iterdir()] == ["trackvib.fmu"]
    assert (tmp_path / "trackvib.fmu").read_text() == "mine"


def test_another_python_is_told(tmp_path):
    """The module in the FMU says at once which Python it needs."""
    trackvib("fmu", "--speed", "0", "--out", tmp_path / "made.fmu")
    with zipfile.ZipFile(tmp_path / "made.fmu") as made:
        made.extractall(tmp_path)
    told = tmp_path / "resources" / "told.json"
    told.write_text(told.read_text().replace(f'"python": [3, {sys.version_info[1]}]', '"python": [2, 7]'))
    module = (tmp_path / "resources" / "slavemodule.txt").read_text()
    done = subprocess.run(
        [sys.executable, "-c", f"import {module}"], cwd=told.parent, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(told.parent)},
    )  # fmt: skip
    assert "this FMU needs Python 2.7" in done.stderr
