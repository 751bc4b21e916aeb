"""Starts the four nodes of the closed loop and ends them all when the simulator is done."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

NODES = (
    ("trackvib_sim", "road_excitation"),
    ("mr_mount_controller", "controller"),
    ("trackvib_sim", "recorder"),
    ("trackvib_sim", "simulator"),
)


def generate_launch_description():
    """Return the description; `parameters:=FILE` takes another parameter file."""
    config = Path(get_package_share_directory("trackvib_sim")) / "config" / "closed_loop.yaml"
    parameters = DeclareLaunchArgument(
        "parameters", default_value=str(config), description="Parameter file of the four nodes."
    )
    nodes = [
        Node(
            package=package,
            executable=executable,
            name=executable,
            parameters=[LaunchConfiguration("parameters")],
            output="screen",
        )
        for package, executable in NODES
    ]
    simulator = nodes[-1]
    done = RegisterEventHandler(OnProcessExit(target_action=simulator, on_exit=[Shutdown(reason="the run is over")]))
    return LaunchDescription([parameters, *nodes, done])
