"""Message definitions as MCAP wants them (encoding `ros2msg`), from the installed .msg files."""

import re
from pathlib import Path

SEPARATOR = "=" * 80
PRIMITIVE = re.compile(
    r"(bool|byte|char|float32|float64|int8|uint8|int16|uint16|int32|uint32|int64|uint64|string|wstring)(<=\d+)?$"
)


def schema_text(type_name):
    """Return the definition of a message type such as `sensor_msgs/msg/Imu` with all that it depends on.

    The root's text comes first; each dependency follows once, after a line of 80 `=` and a line `MSG: pkg/Type`
    (MCAP registry of schema encodings, "ros2msg").

    Raises
    ------
    LookupError
        The type is not installed here, or ROS 2 is not.
    """
    package, _, name = type_name.split("/")
    found = {}
    _gather(package, name, found)
    (_, root), *rest = found.items()
    return "\n".join([root, *(f"{SEPARATOR}\nMSG: {key}\n{text}" for key, text in rest)])


def _gather(package, name, found):
    key = f"{package}/{name}"
    if key in found:
        return
    try:
        from ament_index_python.packages import get_package_share_directory
    except ImportError:
        raise LookupError(f"the definition of {key} is part of a ROS 2 installation, and there is none") from None
    text = (Path(get_package_share_directory(package)) / "msg" / f"{name}.msg").read_text(encoding="utf-8")
    found[key] = text
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if len(words) < 2 or "=" in words[1]:
            continue
        element = words[0].split("[")[0]
        if not PRIMITIVE.match(element):
            parts = element.split("/")
            # a bare name is of the same package, but for the two that ROS 1 left behind
            if len(parts) == 1:
                parts = ["std_msgs" if element == "Header" else package, element]
            _gather(parts[0], parts[-1], found)
