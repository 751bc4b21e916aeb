"""Starts the nodes of a closed loop and ends them all when the simulator is done."""

import sys
import tempfile
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit, OnShutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from mr_mount_controller.node_base.parameters import ParameterError
from mr_mount_controller.node_base.plain_text import plain_line
from trackvib_sim.nodes.loop_arguments import ARGUMENTS, RECORDER, argument_from_text, loop_parameters
from trackvib_sim.nodes.namespace import full_namespace
from trackvib_sim.vehicle.vehicle_file import VehicleFileError

PACKAGES = {"controller": "mr_mount_controller"}  # of executables that are not in ours
FOUR_PROCESSES = ("road_excitation", "controller", "recorder", "simulator")
ONE_PROCESS = ("recorder", "one_process")
FURTHER = {
    "params_file": ("", "Parameter file for any of the nodes; arguments take precedence."),
    "namespace": ("/", "Namespace of the whole vehicle, including its clock."),
    "one_process": ("false", "Run simulator, road and controller in one process: same results, faster."),
    "bag": ("", "Folder of the bag; empty for bag_<date and time>."),
}


def generate_launch_description():
    """Return the description; its arguments are the options of `trackvib run`."""
    declared = [
        DeclareLaunchArgument(name, default_value="", description=f"{each.description} [{each.default or 'none'}]")
        for name, each in ARGUMENTS.items()
    ]
    for name, (default, words) in FURTHER.items():
        choices = ["true", "false"] if default == "false" else None
        declared.append(DeclareLaunchArgument(name, default_value=default, description=words, choices=choices))
    return LaunchDescription([*declared, OpaqueFunction(function=_start)])


def _start(context):
    told = {name: LaunchConfiguration(name).perform(context) for name in (*ARGUMENTS, *FURTHER)}
    try:
        given = {name: argument_from_text(name, told[name]) for name in ARGUMENTS if told[name]}
        files = [told["params_file"]] if told["params_file"] else []
        parameters, _ = loop_parameters(given, files, full_namespace(told["namespace"]))
    except (ParameterError, VehicleFileError) as error:
        raise RuntimeError(str(error)) from None
    if told["bag"]:
        parameters.give(RECORDER, bag=told["bag"])
    for note in parameters.notes:
        print(f"warning: {plain_line(note)}", file=sys.stderr)
    folder = tempfile.TemporaryDirectory(prefix="trackvib_")
    file = Path(folder.name) / "parameters.yaml"
    parameters.write(file)
    # without names: a program of several nodes would give one to all of them
    nodes = [
        Node(
            package=PACKAGES.get(executable, "trackvib_sim"),
            executable=executable,
            namespace=parameters.namespace,
            parameters=[str(file)],
            output="screen",
        )
        for executable in (ONE_PROCESS if told["one_process"] == "true" else FOUR_PROCESSES)
    ]
    over = OnProcessExit(target_action=nodes[-1], on_exit=[Shutdown(reason="the run is over")])
    ending = OnShutdown(on_shutdown=lambda *_: folder.cleanup())
    return [*nodes, RegisterEventHandler(over), RegisterEventHandler(ending)]
