"""Renews what the documents take from code and commands.

    ./trackvib exec -- python docs/renew.py [DOCUMENT ...]

renews README.md and docs/*.md, or the documents given. Between `<!-- table of: NAME -->` and `<!-- end -->` stands a
table of `code_tables.py`, between `<!-- output of: COMMAND -->` and `<!-- end -->` what a command prints, in a fence.
`tests/test_documents.py` and `tests/test_printed_output.py` fail where either is no longer so.
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from code_tables import TABLES

ROOT = Path(__file__).resolve().parents[1]
MARKED = re.compile(r"<!-- (table|output) of: (.+?) -->\n(.*?)<!-- end -->\n", re.DOTALL)
TIME_LIMIT = 600  # s, for a command that hangs


class Block(NamedTuple):
    """A part of a document that is made by a program."""

    kind: str  # table or output
    source: str  # name of the table, or command
    content: str


def documents():
    """Return the paths of all documents that may hold blocks."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(text):
    """Return the `Block`s of a document in their order.

    Raises
    ------
    ValueError
        A mark stands without the other one of its pair.
    """
    found = [Block(*match) for match in MARKED.findall(text)]
    begins, ends = (len(re.findall(mark, text)) for mark in (r"<!-- (?:table|output) of: ", r"<!-- end -->"))
    if not begins == ends == len(found):
        raise ValueError(f"{begins} marks begin a block and {ends} end one, must be pairs")
    return found


def markdown(rows):
    """Return a table in Markdown; the first row is its head."""
    head, *others = ([re.sub(r"[|<]", r"\\\g<0>", str(cell)) for cell in row] for row in rows)
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, ["---"] * len(head), *others))


def printed(command, folder, domain=None):
    """Return what a command of the documents prints when it runs in a folder, without blanks at the ends of lines.

    Raises
    ------
    ValueError
        It fails.
    """
    words = shlex.split(command)
    if words[0] == "./trackvib":
        words[0] = str(ROOT / "trackvib")
    env = {**os.environ, "COLUMNS": "100", "TERM": "dumb"}
    if domain is not None:
        env["ROS_DOMAIN_ID"] = str(domain)
    done = subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True, timeout=TIME_LIMIT)
    if done.returncode:
        raise ValueError(f"{command} ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
    return "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines())


def renewed(text):
    """Return a document with every block made anew."""

    def anew(match):
        kind, source, _ = match.groups()
        if kind == "table":
            content = markdown(TABLES[source]())
        else:
            with tempfile.TemporaryDirectory() as folder:
                content = f"```text\n{printed(source, folder)}```\n"
        return f"<!-- {kind} of: {source} -->\n{content}<!-- end -->\n"

    blocks(text)
    return MARKED.sub(anew, text)


def main():
    """Renew documents."""
    for path in [Path(word) for word in sys.argv[1:]] or documents():
        text = path.read_text(encoding="utf-8")
        path.write_text(renewed(text), encoding="utf-8")


if __name__ == "__main__":
    main()
