"""Renews what the documents take from code and commands.

    ./trackvib exec -- python docs/renew.py [DOCUMENT ...]

renews README.md, docs/*.md, docs/vehicles/*.md and docs/tutorials/*.md, or the documents given. It makes anew what
stands between `<!-- KIND of: SOURCE -->` and `<!-- end -->`: a `table` of `code_tables.py` by its name, the `output` of
a command in a fence, or the `picture` that a command leaves under the name that the document shows. Tutorials are
followed as `tutorial_pages.py` says. `tests/test_documents.py`, `tests/test_printed_output.py` and
`tests/test_tutorials.py` fail where the document has something else.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import tutorial_pages
from code_tables import TABLES

ROOT = Path(__file__).resolve().parents[1]
MARKED = re.compile(r"<!-- (table|output|picture) of: (.+?) -->\n(.*?)<!-- end -->\n", re.DOTALL)
TIME_LIMIT = 600  # s, for a command that hangs


class Block(NamedTuple):
    """A part of a document that is made by a program."""

    kind: str  # table, output or picture
    source: str  # name of the table, or command
    content: str


def documents():
    """Return the paths of all documents that may hold blocks."""
    docs = ROOT / "docs"
    below = (path for part in (".", "vehicles", "tutorials") for path in sorted((docs / part).glob("*.md")))
    return [ROOT / "README.md", *below]


def blocks(text):
    """Return the `Block`s of a document in their order.

    Raises
    ------
    ValueError
        A mark stands without the other one of its pair.
    """
    found = [Block(*match) for match in MARKED.findall(text)]
    begins, ends = (len(re.findall(mark, text)) for mark in (r"<!-- (?:table|output|picture) of: ", r"<!-- end -->"))
    if not begins == ends == len(found):
        raise ValueError(f"{begins} marks begin a block and {ends} end one, must be pairs")
    return found


def markdown(rows):
    """Return a table in Markdown; the first row is its head."""
    head, *others = ([_cell(str(cell)) for cell in row] for row in rows)
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, ["---"] * len(head), *others))


def _cell(text):
    """Keep what Markdown takes for a column, and outside of code for HTML."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else part.replace("<", "&lt;") for part in parts).replace("|", "\\|")


class Commands:
    """Runs each command of the documents once, in a folder of its own below `top`.

    `prepare(command, folder)` may put there what an interrupted command would have left.
    """

    def __init__(self, top, prepare=lambda command, folder: None, **environment):
        self._top, self._prepare = Path(top), prepare
        self._env = {**os.environ, "COLUMNS": "100", "TERM": "dumb", **environment}
        self._done = {}

    def run(self, command):
        """Return what a command prints, without blanks at the ends of lines, and the folder in which it ran.

        Raises
        ------
        ValueError
            It fails.
        """
        if command not in self._done:
            words = shlex.split(command)
            if words[:2] == ["./trackvib", "exec"]:
                words = words[words.index("--") + 1 :]
            elif words[0] == "./trackvib":
                words[0] = str(ROOT / "trackvib")
            folder = self._top / str(sum(1 for _ in self._top.iterdir()))
            folder.mkdir()
            (folder / "docs").symlink_to(ROOT / "docs")  # which commands name from the top of a checkout
            self._prepare(command, folder)
            done = subprocess.run(words, cwd=folder, env=self._env, capture_output=True, text=True, timeout=TIME_LIMIT)
            if done.returncode:
                raise ValueError(f"{command} ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
            self._done[command] = "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines()), folder
        return self._done[command]


def shown_picture(block, document):
    """Return the path of the picture that a block of a document shows."""
    return document.parent / re.search(r"]\((.+?)\)", block.content)[1]


def made_picture(block, document, commands):
    """Return the path of the picture that a block's command leaves under the name that the document shows."""
    name = shown_picture(block, document).name
    (path,) = commands.run(block.source)[1].rglob(name)
    return path


def renew(document, commands):
    """Make every block of a document anew."""

    def anew(match):
        block = Block(*match.groups())
        content = block.content
        if block.kind == "table":
            content = markdown(TABLES[block.source]())
        elif block.kind == "output":
            content = f"```text\n{commands.run(block.source)[0]}```\n"
        else:
            shutil.copyfile(made_picture(block, document, commands), shown_picture(block, document))
        return f"<!-- {block.kind} of: {block.source} -->\n{content}<!-- end -->\n"

    text = document.read_text(encoding="utf-8")
    blocks(text)
    document.write_text(MARKED.sub(anew, text), encoding="utf-8")


def renew_tutorial(page, folder):
    """Follow a tutorial, and take over what it prints and draws."""
    folder.mkdir()
    text = page.read_text(encoding="utf-8")
    page.write_text(tutorial_pages.renewed(text, tutorial_pages.follow(page, folder)), encoding="utf-8")
    for made, shown in tutorial_pages.pictures(text):
        shutil.copyfile(folder / made, page.parent / shown)


def main():
    """Renew documents."""
    with tempfile.TemporaryDirectory() as top:
        commands = Commands(top)
        for document in [Path(word).resolve() for word in sys.argv[1:]] or documents():
            if document in tutorial_pages.PAGES:
                renew_tutorial(document, Path(top) / document.stem)
            else:
                renew(document, commands)


if __name__ == "__main__":
    main()
