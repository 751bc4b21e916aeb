"""What README and docs/ show as printed is what the commands print; their Python blocks run."""

import os
import re
import subprocess
import sys
from functools import partial

import pytest

from .documents import DOCUMENTS, ROOT, renew
from .printed_words import SAME_BITS, alike, compared, elements

# By what part a number may differ on a processor of another level than that of the documents, beside one unit of its
# last digit; on one of the same level none may. Contacts of the tracks amplify rounding. With a current changed by
# 1e-12 levels differ by up to 4 %, the work on the mounts by 16 % and what they store by as much of that work, and 11.5
# % of the elements of a run's picture, which shows one second of it. With the stiffness of teeth changed by 1e-12,
# three times, single lines and third octaves of the M113 differ by up to 18 %; which side of its goal a number near it
# falls on is then a matter of rounding, too. Driving forces then differ by 1.5 %, between compilations by up to 7 %,
# and the heat of those parts that are named by up to 9 %. Over obstacles, with the current changed by 1e-12 three
# times, peaks below 10 Hz differ by up to 8 %.
SCATTER = {
    "./trackvib run": 0.1,
    "./trackvib study table1": 0.1,
    "./trackvib study m113": 0.3,
    "./trackvib study resistance": 0.1,
    "./trackvib exec -- python docs/examples/obstacles.py": 0.15,
    "./trackvib exec -- python docs/examples/field_test.py": 0.15,
    "./trackvib exec -- sh docs/examples/moving_picture.sh": 0.1,
}
ALIKE, ALIKE_IN_SCATTER, ALIKE_IN_RUN = 2e-4, 0.1, 0.13  # part of a picture's elements that may differ

pytestmark = pytest.mark.system


def shown(kind):
    """Give all blocks of a kind in the documents, with their documents, as pytest's parameters."""
    for path in renew.documents():
        for block in renew.blocks(path.read_text(encoding="utf-8")):
            if block.kind == kind:
                yield pytest.param(block, path, id=block.source.removeprefix("./"))


@pytest.fixture(scope="module")
def commands(tmp_path_factory, domain, kept_cases):
    """Each command runs once for all that the documents take from it; studies lack what other tests have not driven."""

    def prepare(command, folder):
        if study := re.match(r"\./trackvib study (\w+)", command):
            kept_cases.give(folder / study[1], study[1])

    return renew.Commands(tmp_path_factory.mktemp("commands"), prepare, ROS_DOMAIN_ID=str(domain))


def python(document):
    """Return the Python blocks of a document but the controller as a node, which has no end and a test of its own."""
    blocks = re.findall(r"^```python\n(.*?)^```", document.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return "\n".join(block for block in blocks if "rclpy.spin" not in block)


def programs():
    """Give the documents with Python in them as pytest's parameters."""
    return (pytest.param(path, id=path.name) for path in DOCUMENTS if python(path))


def scatter(block):
    """Return by what part numbers of a block's command may differ here."""
    return 0.0 if SAME_BITS else next((part for start, part in SCATTER.items() if block.source.startswith(start)), 0.0)


@pytest.mark.slow(reason="a whole run in real processes, and a study of 27 drives")
@pytest.mark.parametrize(("block", "document"), list(shown("output")))
def test_output_is_what_the_command_prints(block, document, commands):
    """The words are the same, and the numbers but for scatter; `python docs/renew.py` renews them."""
    before, now = compared(block.content), compared(commands.run(block.source)[0])
    assert len(before) > 3
    for old, new in zip(before, now, strict=True):
        assert alike(old, new, scatter(block)), f"the document has\n{old}\nand the command prints\n{new}"


@pytest.mark.slow(reason="the same commands")
@pytest.mark.parametrize(("block", "document"), list(shown("picture")))
def test_picture_is_what_the_command_draws(block, document, commands):
    """Picture elements are the same but for scatter, likewise."""
    paths = (renew.shown_picture, partial(renew.made_picture, commands=commands))
    old, new = (elements(path(block, document)) for path in paths)
    assert old.shape == new.shape
    different = (abs(old - new).max(axis=-1) > 0.1).mean()
    of_scatter = ALIKE_IN_RUN if block.source == "./trackvib run" else ALIKE_IN_SCATTER
    assert different <= (of_scatter if scatter(block) else ALIKE)


@pytest.mark.parametrize(
    ("shown", "printed", "scatter", "same"),
    [
        ("chassis 3.467 2.353", "chassis 3.567 2.353", 0.05, True),
        ("chassis 3.467 2.353", "chassis 3.667 2.353", 0.05, False),
        ("chassis 3.467 2.353", "chassis 3.468 2.353", 0.0, True),
        ("chassis 3.467 2.353", "chassis 3.469 2.353", 0.0, False),
        ("lost 0 of 10000", "lost 1 of 10000", 0.05, False),
        ("whole heave 52%", "whole heave 53%", 0.0, True),
        ("whole heave 52%", "whole pitch 52%", 0.0, False),
        ("mounts: 342.1 J of work, +32.4 stored", "mounts: 288.0 J of work, -0.7 stored", 0.05, True),
        ("mounts: 342.1 J of work, +32.4 stored", "mounts: 142.1 J of work, +32.4 stored", 0.05, False),
    ],
)
def test_comparison_sees_what_differs(shown, printed, scatter, same):
    """Words, counts and numbers beyond their scatter tell; rounding does not."""
    assert alike(shown, printed, scatter) == same


@pytest.mark.slow(reason="programs that drive whole vehicles")
@pytest.mark.parametrize("document", list(programs()))
def test_python_blocks_run(document, recorded_run, tmp_path):
    """The blocks of a document, one after the other in one program."""
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "first").symlink_to(recorded_run)
    (tmp_path / "program.py").write_text(python(document), encoding="utf-8")
    paths = [str(ROOT / "docs" / "examples" / "my_controller"), os.environ.get("PYTHONPATH", "")]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run([sys.executable, "program.py"], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
