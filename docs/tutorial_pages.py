"""Runs a tutorial as its reader does: files are saved, commands are typed, and what they print is collected.

In a page of `docs/tutorials/`

* a fence with a `title` is a file to save,
* a fence `sh` holds commands; the fence `text` that follows has what they print,
* `<!-- file: PATH -->` before a picture names the file that the commands leave.

All commands of a page go to one shell, which ends at the first that fails.
"""

import os
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PAGES = sorted((ROOT / "docs" / "tutorials").glob("[0-9]*.md"))
FENCE = re.compile(r"^```(?P<kind>\w+)(?: title=\"(?P<title>[^\"]+)\")?\n(?P<text>.*?)^```\n", re.DOTALL | re.MULTILINE)
PICTURE = re.compile(r"<!-- file: (?P<made>\S+) -->\n!\[[^\]]*\]\((?P<shown>[^)]+)\)")
MARK = "--- of the next block ---"
TIME_LIMIT = 900  # s, for a page that hangs


class Step(NamedTuple):
    """Commands of a page, and what the page says that they print; None where it says nothing."""

    commands: str
    printed: str | None


def steps(text):
    """Return the files that a page has its reader save, by name, and its `Step`s in their order."""
    files, found = {}, []
    for fence in FENCE.finditer(text):
        if fence["title"]:
            files[fence["title"]] = fence["text"]
        elif fence["kind"] == "sh":
            found.append(Step(fence["text"], None))
        elif fence["kind"] == "text":
            found[-1] = found[-1]._replace(printed=fence["text"])
    return files, found


def follow(page, folder, **environment):
    """Follow a page in an empty folder; return what each of its steps prints.

    Raises
    ------
    ValueError
        A command fails.
    """
    files, todo = steps(page.read_text(encoding="utf-8"))
    (folder / "trackvib").symlink_to(ROOT / "trackvib")
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    script = "set -eo pipefail\n" + "".join(f"{step.commands}echo '{MARK}'\n" for step in todo)
    env = {**os.environ, "COLUMNS": "100", "TERM": "dumb", **environment}
    done = subprocess.run(["bash", "-c", script], cwd=folder, env=env, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=TIME_LIMIT)  # fmt: skip
    if done.returncode:
        raise ValueError(f"{page.name} ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
    lines = "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines())
    return lines.split(f"{MARK}\n")[: len(todo)]


def pictures(text):
    """Return pairs: the file that the commands leave, and the picture that the page shows."""
    return [(match["made"], match["shown"]) for match in PICTURE.finditer(text)]


def renewed(text, printed):
    """Return a page's text with what its steps print now."""
    now = iter(printed)
    output = ""

    def anew(fence):
        nonlocal output
        if fence["kind"] == "sh" and not fence["title"]:
            output = next(now)
        return f"```text\n{output}```\n" if fence["kind"] == "text" else fence[0]

    return FENCE.sub(anew, text)
