"""What the README says about nodes, topics and parameters is what the code has."""

import re
from pathlib import Path

import pytest
from mr_mount_controller.node import PARAMETERS as CONTROLLER
from mr_mount_controller.node_base import topics
from trackvib_sim.nodes.player import PARAMETERS as PLAYER
from trackvib_sim.nodes.recorder import PARAMETERS as RECORDER
from trackvib_sim.nodes.road_excitation import PARAMETERS as ROAD
from trackvib_sim.nodes.simulator_parameters import PARAMETERS as SIMULATOR

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
BAGS = (ROOT / "docs" / "bags.md").read_text()


@pytest.mark.property
@pytest.mark.parametrize("parameter", [*SIMULATOR, *ROAD, *RECORDER, *CONTROLLER], ids=lambda p: p.name)
def test_every_parameter_is_in_the_readme(parameter):
    """Each stands in a table with its default and range."""
    row = re.search(rf"^\| `{parameter.name}` \|(.*)\|$", README, re.MULTILINE)
    assert row, f"no row for {parameter.name}"
    for each in (*parameter.choices, *(f"{x:g}" for x in (parameter.low, parameter.high) if x is not None)):
        assert each in row[1], f"{parameter.name}: {each} is not in its row"
    if parameter.default not in ("", []) and not isinstance(parameter.default, list):
        default = str(parameter.default).lower() if isinstance(parameter.default, bool) else parameter.default
        assert f"`{default}`" in row[1], f"{parameter.name}: default {default} is not in its row"


@pytest.mark.property
@pytest.mark.parametrize("parameter", PLAYER, ids=lambda p: p.name)
def test_every_parameter_of_the_player_is_in_its_document(parameter):
    """Likewise."""
    row = re.search(rf"^\| `{parameter.name}` \|(.*)\|$", BAGS, re.MULTILINE)
    assert row, f"no row for {parameter.name}"
    for limit in (parameter.low, parameter.high):
        assert limit is None or f"{limit:g}" in row[1]


@pytest.mark.property
def test_every_topic_is_in_the_readme():
    """Each topic stands in the table of topics."""
    names = [value for key, value in vars(topics).items() if key.isupper() and not key.endswith("_FRAME")]
    assert len(names) == 10
    for name in names:
        assert f"| `{name}` |" in README, name


@pytest.mark.property
def test_every_dependency_has_its_reason():
    """Each direct requirement stands in docs/dependencies.md."""
    text = (ROOT / "docs" / "dependencies.md").read_text()
    for file in sorted((ROOT / "environment").glob("requirements*.in")):
        for line in file.read_text().splitlines():
            name = re.match(r"[A-Za-z][\w.-]*", line)
            if name:
                assert f"`{name[0]}`" in text, f"{file.name}: {name[0]}"
