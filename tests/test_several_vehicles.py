"""Several vehicles in one ROS domain, each whole in a namespace; what runs are told by parameter files."""

import ast
import os
from pathlib import Path

import numpy as np
import pytest
import yaml
from ament_index_python.packages import get_package_share_directory
from mcap.reader import make_reader
from mr_mount_controller.laws import find_law
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.commands.run_cli import run
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.loop_arguments import ARGUMENTS, NODES
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .processes import Program, trackvib

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="does runs of some seconds")]

SPEED, SEED, PERIODS = 9.0, 2, 3500
FOR_ALL = """
/**:
  ros__parameters: {law: hybrid, seed: 2, speed: 5.0, duration: 3.5, firm_current: 2.5, of_nobody: 1}
/**/simulator:
  ros__parameters: {speed: 8}
"""
LAUNCH = Path(get_package_share_directory("trackvib_sim")) / "launch" / "closed_loop.launch.py"
NAMED_OTHERWISE = {"files": "params_file", "out": "bag"}
_SAID = "a parameter file for several nodes contains parameters that this node does not have:"


@pytest.fixture(scope="module")
def side_by_side(recorded_run, tmp_path_factory, domain):
    """Two runs at the same time in one domain, one of them in a namespace: their folder, and what a third one said."""
    folder = tmp_path_factory.mktemp("several")
    (folder / "for_all.yaml").write_text(FOR_ALL)
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}

    def begin(name, *options):
        words = ("run", *map(str, options), "--out", str(folder / name))
        return Program("trackvib", list(words), folder / f"{name}.log", env, folder)

    left = begin("left", "--law", "skyhook", "--duration", 3.2, "--namespace", "lab/left", "--one-process")
    root = begin("root", "--params-file", folder / "for_all.yaml", "--speed", SPEED)
    try:
        left.wait_for("closed loop:")
        refused = trackvib("run", "--namespace", "/lab/left", "--out", folder / "third", code=1, env=env)
        assert (left.wait(), root.wait()) == (0, 0), left.output + root.output
    finally:
        left.clean_up()
        root.clean_up()
    return folder, refused


def streams(bag):
    """Return the serialised messages of a bag by topic."""
    found = {}
    with next(bag.glob("*.mcap")).open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            found.setdefault(channel.topic, []).append(message.data)
    return found


def test_a_vehicle_in_a_namespace_is_as_alone(side_by_side, recorded_run):
    """Every topic of its bag lies in the namespace, its clock too, and all bits are those of a run alone."""
    left, alone = streams(side_by_side[0] / "left" / "bag"), streams(recorded_run / "bag")
    assert {f"/lab/left{topic}" for topic in alone} == set(left)
    for topic in alone.keys() - {"/clock", "/diagnostics", "/road_profile"}:  # which tell again while a run stands
        assert left[f"/lab/left{topic}"] == alone[topic], topic


def test_a_bag_of_a_namespace_is_driven_again(side_by_side, tmp_path):
    """To the same bits, and under another law into a bag with the same topics."""
    bag = side_by_side[0] / "left" / "bag"
    assert "identical to the last bit" in trackvib("replay", bag, "--verify")
    trackvib("replay", bag, "--law", "hybrid", "--out", tmp_path / "again")
    assert streams(tmp_path / "again" / "bag").keys() == streams(bag).keys()


def test_a_vehicle_beside_one_in_a_namespace_is_as_alone(side_by_side):
    """Of the one in no namespace, too: samples and currents are those of the loop in one process."""
    drive = read_recording(side_by_side[0] / "root" / "bag")
    assert not [topic for topic in drive.counts if topic.startswith("/lab")]
    vehicle, _ = read_vehicle(find_vehicle())
    rates = Rates(recommended_rate(vehicle))
    simulation = Simulation(vehicle, RunSettings(Operation(SPEED, 1650.0, False, 0.25), rates, 1.0))
    law = find_law("hybrid")(1e-3, firm_current=2.5)
    record = run_closed_loop(simulation, Iso8608Road("E", SEED, 8.0, 8.0), law, PERIODS)
    np.testing.assert_array_equal(record.specific_force[:, 1], drive.powertrain.specific_force)
    np.testing.assert_array_equal(record.current, drive.answers.current)


def test_a_namespace_is_taken_once(side_by_side):
    """A second run in the same one is refused; the error says what to change."""
    assert "namespace /lab/left" in side_by_side[1] and "set another ROS_DOMAIN_ID or --namespace" in side_by_side[1]
    assert not (side_by_side[0] / "third").exists()


def test_what_a_file_gives_to_all_nodes(side_by_side):
    """An option counts more than the file; each node names once what it does not know."""
    folder = side_by_side[0] / "root"
    provenance = read_recording(folder / "bag").provenance
    assert provenance["parameters of /simulator"]["speed"] == f"{SPEED}"
    assert provenance["parameters of /controller"]["firm_current"] == "2.5"
    for node in NODES:
        (said,) = [line for line in (folder / "log" / f"{node}.log").read_text().splitlines() if _SAID in line]
        assert "of_nobody" in said and ("law" in said) == (node != "controller")
    assert set(yaml.safe_load((folder / "log" / "parameters.yaml").read_text())) >= {"/**/simulator", "/simulator"}


@pytest.mark.parametrize(
    ("options", "file", "said"),
    [
        (["--namespace", "9lives"], None, ["namespace is '9lives'", "letters, digits and _"]),
        ([], "/**: {ros__parameters: {speed: fast}}", ["parameter 'speed' is 'fast'", "from -25 to 25 m/s"]),
        ([], "simulator: {speed: 5.0}", ["for_run.yaml", "has no section", "ros__parameters"]),
        ([], "/**: {ros__parameters: {duration: 0.5}}", ["duration is 0.5 s, must be at least"]),
        (["--law-parameters", "firm_current"], None, ["law_parameters is 'firm_current'", "NAME=VALUE"]),
    ],
)
def test_what_cannot_be_used_is_refused(tmp_path, options, file, said):
    """With item, value and what is accepted, before anything is made."""
    if file:
        (tmp_path / "for_run.yaml").write_text(file)
        options = [*options, "--params-file", tmp_path / "for_run.yaml"]
    printed = trackvib("run", *options, "--out", tmp_path / "out", code=1)
    assert all(words in printed for words in said), printed
    assert printed.startswith("error: ") and not (tmp_path / "out").exists()


@pytest.mark.property
def test_each_option_of_a_run_is_an_argument_of_the_launch_file():
    """By the same name, but for two."""
    (further,) = (
        ast.literal_eval(node.value)
        for node in ast.parse(LAUNCH.read_text(encoding="utf-8")).body
        if isinstance(node, ast.Assign) and node.targets[0].id == "FURTHER"
    )
    options = {NAMED_OTHERWISE.get(parameter.name, parameter.name) for parameter in run.params}
    assert options == {*ARGUMENTS, *further}


def test_launch_file(start, tmp_path):
    """`ros2 launch` runs a vehicle in a namespace, with a parameter file, to the end."""
    (tmp_path / "for_all.yaml").write_text(FOR_ALL)
    arguments = ("namespace:=right", "duration:=0.5", f"params_file:={tmp_path}/for_all.yaml", f"bag:={tmp_path}/bag")
    launched = start(["ros2", "launch", "trackvib_sim", "closed_loop.launch.py", *arguments])
    assert launched.wait() == 0, launched.output
    assert read_recording(tmp_path / "bag").provenance["parameters of /right/simulator"]["speed"] == "8.0"
