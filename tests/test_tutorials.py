"""The tutorials: each page is followed in an empty folder, with real processes, and prints and draws what it says."""

import re
import socket

import pytest
from matplotlib.image import imread

from .documents import tutorial_pages
from .printed_words import NUMBER, SAME_BITS, compared
from .printed_words import alike as alike_to_the_digit

# Part of the largest number in a line by which others may differ on a processor of another level: contacts amplify
# what it rounds, and short runs of few seeds scatter the more.
SCATTER = 0.3
STUDY = re.compile(r"^\./trackvib study (\w+) .*--out (\w+)", re.MULTILINE)
INTERVAL = re.compile(r"([-+]?\d+\.\d+) ± (\d+\.\d+)")

pytestmark = pytest.mark.system


def alike(shown, printed):
    """Whether two lines have the same words, and numbers that are about the same; counts alone are the same.

    Of means with their intervals it is enough that these overlap; stars mark those that leave zero out.
    """
    shown, printed = shown.replace("*", ""), printed.replace("*", "")
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    means = zip(INTERVAL.findall(shown), INTERVAL.findall(printed), strict=True)
    if any(abs(float(a) - float(b)) > float(around_a) + float(around_b) for (a, around_a), (b, around_b) in means):
        return False
    old, new = (
        [float(each.rstrip("%")) for each in NUMBER.findall(INTERVAL.sub("", line))] for line in (shown, printed)
    )
    most = SCATTER * max((abs(float(each.rstrip("%"))) for each in NUMBER.findall(shown)), default=0.0)
    most = most if "." in shown else 0.0
    return all(abs(a - b) <= most for a, b in zip(old, new, strict=True))


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
                same = alike_to_the_digit(old, new, 0.0) if SAME_BITS else alike(old, new)
                assert same, f"the page has\n{old}\nand the commands print\n{new}"
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
    ("shown", "printed", "same"),
    [("13.0 kN, 1.5 of 3", "12.0 kN, 3.1 of 3", True), ("13.0 kN, 1.5", "12.0 kN, 6.1", False),
     ("3000 samples", "2999 samples", False), ("a 1.0", "b 1.0", False),
     ("gain **+4.0 ± 1.0**", "gain +2.5 ± 2.6", True), ("gain +4.0 ± 1.0", "gain +1.5 ± 1.0", False)],
)  # fmt: skip
def test_comparison_sees_what_differs(shown, printed, same):
    """Words and counts tell, and numbers beyond their scatter."""
    assert alike(shown, printed) == same
