"""Parameter files: which names come by a wildcard, and so to nodes that do not have them."""

import pytest
from mr_mount_controller.node_base.parameter_files import given_by_wildcard

FILE = """
/**:
  ros__parameters: {law: skyhook, gains: {upper: 1.0, lower: {left: 2.0}}}
/twin/*/simulator:
  ros__parameters: {speed: 5.0}
twin:
  controller:
    ros__parameters: {coils: 2}
  "*":
    ros__parameters: {seed: 1}
empty:
  ros__parameters:
"""


@pytest.mark.property
def test_names_by_wildcard(tmp_path):
    """Nested namespaces, names within names, several files; a node called by its name is none."""
    (tmp_path / "a.yaml").write_text(FILE)
    (tmp_path / "b.yaml").write_text("")
    arguments = ["node", "--ros-args", "--params-file", str(tmp_path / "b.yaml"), "-p", "law:=passive"]
    assert given_by_wildcard(arguments) == set()
    arguments += ["--params-file", str(tmp_path / "a.yaml")]
    assert given_by_wildcard(arguments) == {"law", "gains.upper", "gains.lower.left", "speed", "seed"}
