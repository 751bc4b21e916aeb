"""`ros2 launch`: runs a launch file in Python with the part of ROS 2's `launch` that lies in `launch_api`.

What that part lacks is named, and nothing is started then. Unlike ROS 2's own, the exit code is 1 where a process died
by itself with another code than 0, and all output goes to the terminal.
"""

import sys
from pathlib import Path

from environment.ros2_stand_in.programs import share_folder
from environment.ros2_stand_in.terminal import Failure, line

sys.path.append(str(Path(__file__).parent / "launch_api"))

from launch import LaunchContext, LaunchError, load_description  # noqa: E402
from launch.actions import DeclareLaunchArgument  # noqa: E402
from launch.processes import Processes  # noqa: E402


def launch(chosen):
    """Start what the file describes, print what it prints, and end it all when it is done or interrupted."""
    path, words = _file(chosen.package_name, chosen.words)
    given = dict(_argument(word) for word in words)
    context = LaunchContext(given, Processes())
    try:
        description = load_description(path)
        if chosen.show_args:
            _show_arguments(description)
            return 0
        context.visit(description)
        return context.processes.run(context)
    except LaunchError as error:
        raise Failure(error) from None
    finally:
        context.processes.close()


def _file(package, words):
    if Path(package).is_file():
        return Path(package), words
    if not words:
        raise Failure(f"{package} is no file; a package wants the name of its launch file, too")
    folder = share_folder(package)
    found = sorted(path for path in folder.rglob(words[0]) if path.is_file()) if Path(words[0]).name == words[0] else []
    if not found:
        there = ", ".join(sorted(path.name for path in folder.rglob("*.launch.py"))) or "none"
        raise Failure(f"file '{words[0]}' was not found in the share directory of package '{package}'; it has: {there}")
    return found[0], words[1:]


def _argument(word):
    name, sign, value = word.partition(":=")
    if not name or not sign:
        raise Failure(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
    return name, value


def _show_arguments(description):
    line("Arguments (pass arguments as '<name>:=<value>'):")
    declared = [entity for entity in description.entities if isinstance(entity, DeclareLaunchArgument)]
    for each in declared:
        line()
        line(f"    '{each.name}':")
        line(f"        {each.description or 'no description given'}")
        if each.choices:
            line(f"        one of {', '.join(each.choices)}")
        if each.default_value is not None:
            line(f"        (default: '{each.default_text()}')")
    if not declared:
        line("  No arguments.")
