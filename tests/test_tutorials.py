"""The tutorials: each page is followed in an empty folder, with real processes, and prints and draws what it says."""

import re
import socket

import pytest
from matplotlib.image import imread

from .documents import tutorial_pages
from .printed_words import NUMBER, SAME_BITS, compared
from .printed_words import alike as alike_to_the_digit

STUDY = re.compile(r"^\./trackvib study (\w+) .*--out (\w+)", re.MULTILINE)

pytestmark = pytest.mark.system


def alike(shown, printed, same_bits):
    """Whether two lines have the same words and numbers; on a processor of another level than that of the pages counts.

    Contacts amplify what such a processor rounds: single lines and samples of runs so short, and gains over so few
    seeds, then differ by a factor of two. Stars of gains that leave zero out come and go.
    """
    if same_bits or "." not in shown:
        return alike_to_the_digit(shown, printed, 0.0)
    words, others = (NUMBER.sub("#", line.replace("*", "")).split() for line in (shown, printed))
    return words == others


def free_port():
    """Return a port of this machine that nobody uses."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.mark.slow(reason="runs and studies in real processes")
@pytest.mark.parametrize("page", tutorial_pages.PAGES, ids=lambda page: page.stem)
def test_page_does_what_it_says(page, tmp_path, domain, kept_cases):
    """Every command succeeds and prints what the page shows; the last picture is the one that they leave."""
    text = page.read_text(encoding="utf-8")
    (tmp_path / "work").mkdir()
    found = tutorial_pages.follow(page, tmp_path / "work", ROS_DOMAIN_ID=str(domain), PORT=str(free_port()))
    for step, printed in zip(tutorial_pages.steps(text)[1], found, strict=True):
        if step.printed is not None:
            before, now = compared(step.printed), compared(printed)
            assert before, step.commands
            for old, new in zip(before, now, strict=True):
                assert alike(old, new, SAME_BITS), f"the page has\n{old}\nand the commands print\n{new}"
    for study, folder in STUDY.findall(text):
        kept_cases.keep(tmp_path / "work" / folder, study)
    ((made, shown),) = tutorial_pages.pictures(text)
    assert imread(tmp_path / "work" / made).shape == imread(page.parent / shown).shape


def test_pages_are_whole():
    """Each page ends with a picture, and what is printed belongs to a command."""
    assert len(tutorial_pages.PAGES) == 7
    for page in tutorial_pages.PAGES:
        text = page.read_text(encoding="utf-8")
        files, steps = tutorial_pages.steps(text)
        assert steps and any(step.printed for step in steps), page.name
        assert text.rstrip().splitlines()[-1].startswith("!["), page.name
        assert f"]({page.name})" in (page.parent / "index.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("shown", "printed", "same_bits", "same"),
    [("13.0 kN, 1.5 of 3", "12.0 kN, 3.1 of 3", False, True), ("13.0 kN, 1.5", "12.0 kN, 1.5", True, False),
     ("13.0 kN, 1.5", "13.0 kN, 1.5", True, True), ("3000 samples", "2999 samples", False, False),
     ("a 1.0", "b 1.0", False, False), ("gain +4.0 ± 1.0 *", "gain +1.5 ± 2.6", False, True)],
)  # fmt: skip
def test_comparison_sees_what_differs(shown, printed, same_bits, same):
    """Words and counts tell, and numbers where bits are the same."""
    assert alike(shown, printed, same_bits) == same
