"""What README and docs/ say of the code is what the code has; their lines, links and names of files are sound."""

import importlib
import re
import shlex
import sys
from importlib.util import find_spec
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.topic_table import TOPICS
from trackvib_sim.data import paper_table_file
from trackvib_sim.studies.paper.paper_table import read_table

from .documents import DOCUMENTS, ROOT, code_tables, renew, tutorial_pages

WIDTH = 120
OF_READERS = {"my_controller.py"}.union(*(tutorial_pages.steps(path.read_text())[0] for path in tutorial_pages.PAGES))
CODE = [path for part in ("ros2_ws/src", "tests", "bench", "docs", "environment", "docker", ".github")
        for path in (ROOT / part).rglob("*") if path.is_file()]  # fmt: skip

pytestmark = pytest.mark.property
each_document = pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)


@pytest.mark.parametrize("document", renew.documents(), ids=lambda path: path.name)
def test_tables_are_those_of_the_code(document):
    """Each table made from the code is as it would be made now; `python docs/renew.py` renews them."""
    for block in renew.blocks(document.read_text(encoding="utf-8")):
        if block.kind == "table":
            assert block.content == renew.markdown(code_tables.TABLES[block.source]()), block.source


def test_every_table_is_in_a_document():
    """No table of the code is left out, or stands twice."""
    found = [block.source for path in renew.documents() for block in renew.blocks(path.read_text(encoding="utf-8"))
             if block.kind == "table"]  # fmt: skip
    assert sorted(found) == sorted(code_tables.TABLES)


def test_every_topic_has_its_row():
    """Each name of a topic is described once."""
    names = [value for key, value in vars(topics).items() if key.isupper() and isinstance(value, str)]
    others = [value for key, value in vars(topics).items() if key.endswith(("_FRAME", "_TYPE"))]
    assert sorted(set(names) - set(others)) == sorted(topic.name for topic in TOPICS)


@pytest.mark.slow(reason="a whole run")
@pytest.mark.system
def test_topics_have_the_types_that_travel(recorded_run):
    """The bag of a run holds every topic of the table, with its type, but more sensors and what the simulator does not
    say."""
    described = {topic.name.removeprefix("/"): topic.type for topic in TOPICS}
    for absent in (
        topics.RECORDED,
        topics.RECORDED_ANSWERS,
        topics.RECORDED_TOPICS,
        topics.FURTHER_IMU,
        topics.CMD_VEL,
    ):
        del described[absent]
    if_wanted = [topic.name.removeprefix("/") for topic in TOPICS if "_rate`" in topic.rate]
    for absent in if_wanted:
        del described[absent]
    metadata = yaml.safe_load((recorded_run / "bag" / "metadata.yaml").read_text())
    told = metadata["rosbag2_bagfile_information"]["topics_with_message_count"]
    found = {each["topic_metadata"]["name"].removeprefix("/"): each["topic_metadata"]["type"] for each in told}
    assert found == described


def test_rows_say_default_range_and_unit():
    """A parameter's row has its default, what is accepted with the unit, and its meaning."""
    rows = {row[0]: row[1:] for row in code_tables.TABLES["parameters of simulator"]()}
    assert rows["`speed`"] == (
        "`10.0`",
        "-25 to 25 m/s",
        "Constant speed, if no drive file gives it; negative for reverse.",
    )
    assert rows["`wait_for_recorder`"][:2] == ("`false`", "`false`, `true`")
    road = {row[0]: row[1:] for row in code_tables.TABLES["parameters of road_excitation"]()}
    assert road["`coherence`"][1] == "`isotropic`, `exponential`"


def test_cells_keep_their_signs():
    """What Markdown would take for a column or for HTML is escaped."""
    rows = [("a", "b", "c"), ("x|y", "<z>", "`<`")]
    assert renew.markdown(rows) == "| a | b | c |\n| --- | --- | --- |\n| x\\|y | &lt;z> | `<` |\n"


def test_only_blocks_are_renewed(tmp_path):
    """What stands around the marks stays; what stands in them is the program's, printed or drawn."""
    document = tmp_path / "page.md"
    draw = f"{shlex.quote(sys.executable)} -c \"print(3); open('a.png', 'w').write('drawn')\""
    output, picture = (f"<!-- {kind} of: {draw} -->\n![](a.png)\n<!-- end -->\n" for kind in ("output", "picture"))
    document.write_text(f"before\n<!-- table of: mount -->\nold\n<!-- end -->\n{output}{picture}after\n")
    renew.renew(document, renew.Commands(tmp_path))
    text = document.read_text()
    assert text.startswith("before\n<!-- table of: mount -->\n| current, A |") and "\nold\n" not in text
    assert text.endswith(output.replace("![](a.png)", "```text\n3\n```") + picture + "after\n")
    assert (tmp_path / "a.png").read_text() == "drawn"


def test_commands_that_fail_are_named(tmp_path):
    """A document is not renewed with half an output."""
    with pytest.raises(ValueError, match="exit code 3"):
        renew.Commands(tmp_path).run(f"{shlex.quote(sys.executable)} -c 'exit(3)'")


@pytest.mark.parametrize("text", ["<!-- table of: mount -->\n", "<!-- end -->\n"])
def test_single_marks_are_refused(text):
    """Half a pair of marks is no block."""
    with pytest.raises(ValueError, match="must be pairs"):
        renew.blocks(text)


@pytest.mark.literature
def test_what_the_model_does_not_give_follows_from_the_table():
    """Sentences about ours and the paper's levels of the default vehicle, from the rows that docs/studies.md shows."""
    (block,) = (block for block in renew.blocks((ROOT / "docs" / "studies.md").read_text()) if block.kind == "output")
    cells = re.findall(r"^│ ([A-H]) +│ +(\d+) │ ([\d. ]+) │ ([\d. ]+) │", block.content, re.MULTILINE)
    ours = {
        (road, float(speed)): [*map(float, one.split()), *map(float, two.split())] for road, speed, one, two in cells
    }
    paper = read_table(paper_table_file())
    ratio = np.array([np.divide(ours[case], paper[case]) for case in ours])
    assert ratio.shape == (9, 6)
    change = dict(zip(ours, 100.0 * (ratio - 1.0), strict=True))
    means = np.exp(np.log(ratio).mean(axis=0))
    text = " ".join((ROOT / "docs" / "vehicles" / "tao2025.md").read_text().split())
    low20, high5 = (
        sorted(abs(change[road, speed][column]) for road in "ACE") for speed, column in ((20.0, 1), (5.0, 4))
    )
    e10, e20 = sorted(-change["E", 10.0][[2, 5]]), 100.0 * (1.0 - np.divide(ours["E", 20.0][3:], ours["E", 20.0][:3]))
    for words in (
        f"**error factor {np.exp(np.sqrt((np.log(ratio) ** 2).mean())):.2f}** over the nine rows, "
        f"column means {means.min():.2f} to {means.max():.2f} of the paper's",
        f"are {low20[0]:.0f} to {low20[2]:.0f} % low at the chassis, "
        f"those of the powertrain at 5 m/s {high5[0]:.0f} to {high5[2]:.0f} % high",
        f"is {e10[0]:.0f} to {e10[1]:.0f} % low. The paper has "
        f"{100.0 * (paper['E', 10.0][2] / paper['C', 10.0][2] - 1.0):.0f} % more there than on class C",
        f"as shipped, {-e20[0]:.0f} % above",
        f"at E 20 m/s: {e20[1]:.0f} % below, in the paper",
        f"at E 20 m/s {e20[2]:.0f} % (paper",
    ):
        assert words in text, words


def test_every_dependency_has_its_reason():
    """Each direct requirement stands in docs/dependencies.md."""
    text = (ROOT / "docs" / "dependencies.md").read_text()
    for file in sorted((ROOT / "environment").glob("requirements*.in")):
        for line in file.read_text().splitlines():
            name = re.match(r"[A-Za-z][\w.-]*", line)
            if name:
                assert f"`{name[0]}`" in text, f"{file.name}: {name[0]}"


@pytest.mark.parametrize("lock", sorted((ROOT / "environment").glob("*.lock")), ids=lambda path: path.name)
def test_locks_hold_hashes_and_no_addresses(lock):
    """Each pin has its hashes, and where packages are fetched from is the user's own setting."""
    text = lock.read_text()
    entries = re.findall(r"^[\w.-]+==.*(?:\n[ ].*)*", text, re.MULTILINE)
    assert len(entries) == len(re.findall(r"^[^\s#].*", text, re.MULTILINE)) > 0
    for entry in entries:
        assert re.search(r"--hash=sha256:[0-9a-f]{64}\b", entry), entry
    assert not re.search(r"://|--(?:extra-)?index-url|--find-links", text)


@each_document
def test_lines_are_short(document):
    """At most 120 characters, but for tables, code, and addresses."""
    for line in _prose(document).splitlines():
        assert len(line) <= WIDTH or line.startswith(("|", "    ")), line


@each_document
def test_links_lead_somewhere(document):
    """Every relative link and picture is there."""
    for target in re.findall(r"\]\(([^)#]+)\)", _prose(document)):
        assert ":" in target or (document.parent / target).is_file(), target


@pytest.mark.parametrize("document", [path for path in DOCUMENTS if path.name != "CHANGELOG.md"], ids=lambda p: p.name)
def test_named_files_and_modules_are_there(document):
    """A Python file or module that the text names exists under that name."""
    for word in re.findall(r"`([^`\s]+)`", _prose(document)):
        if re.fullmatch(r"[\w/*.]+\.py", word) and word not in OF_READERS:
            assert any(path.match(f"**/{word}") or path.match(word) for path in CODE), word
        if re.fullmatch(r"(trackvib_sim|mr_mount_controller)(\.\w+)+", word):
            module, _, name = word.rpartition(".")
            assert hasattr(importlib.import_module(module), name) or find_spec(word), word


@pytest.mark.parametrize("file", ["CITATION.cff", ".pre-commit-config.yaml", ".github/workflows/ci.yml"])
def test_yaml_files_are_yaml(file):
    """The files that others' programs read can be read."""
    assert isinstance(yaml.safe_load((ROOT / file).read_text(encoding="utf-8")), dict)


def test_hosted_ci_does_what_ci_run_does():
    """Every job of the workflow ends in the one script, so that hosted and local runs test the same."""
    workflow = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
    assert workflow["jobs"]
    for name, job in workflow["jobs"].items():
        assert job["steps"][-1]["run"] == "bash .ci/run", name


def test_versions_are_one():
    """Packages, citation and change log tell the same version."""
    (found,) = {ElementTree.parse(path).findtext("version") for path in ROOT.glob("ros2_ws/src/*/package.xml")}
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))["version"] == found
    assert f"## [{found}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def _prose(document):
    return re.sub(r"^ *```.*?^ *```", "", document.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
