"""Pages of the site that have their text elsewhere: README and the like, the library's names, the command line.

A hook of MkDocs; `mkdocs.yml` names it.
"""

import re
from importlib.util import find_spec
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[1]
PAGES = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "CITATION.cff": "citation.md",
    "LICENSE": "licence.md",
}
FENCED = {"CITATION.cff": ("Citation", "yaml"), "LICENSE": ("Licence", "text")}  # what is no Markdown: title, language
MARK = re.compile(r"<!-- .*? -->\n")  # of docs/renew.py
ABOVE = re.compile(rf"\]\(\.\./({'|'.join(map(re.escape, PAGES))})\b")
LINK = re.compile(r"\]\((docs/)?([\w./-]+)")
EXPORTED = re.compile(r"from (\.\w\S*) import \w+ as (\w+)")
API = """\
# Python API

What `import trackvib_sim as tv`, `trackvib_sim.rui` and `mr_mount_controller.laws` offer. [As a library](library.md)
shows how to use it.
"""
COMMAND_LINE = """\
# Command line

What `./trackvib VERB` takes; `test`, `docs`, `exec`, `shell` and `setup` are in `./trackvib --help`.

::: mkdocs-click
    :module: trackvib_sim.cli
    :command: main
    :prog_name: ./trackvib
    :depth: 1
"""


def on_files(files, config):
    """Add the pages that are not files below `docs/`."""
    for source, page in PAGES.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        if source in FENCED:
            title, language = FENCED[source]
            text = f"# {title}\n\n```{language}\n{text}```\n"
        files.append(File.generated(config, page, content=LINK.sub(_from_the_top, text)))
    files.append(File.generated(config, "api.md", content=API + "".join(_names())))
    files.append(File.generated(config, "command_line.md", content=COMMAND_LINE))
    return files


def on_page_markdown(markdown, page, **_):
    """Take out the marks of `docs/renew.py`, and lead links to pages that lie above `docs/` to their place here."""
    return MARK.sub("\n", ABOVE.sub(_into_the_site, markdown))


def _from_the_top(match):
    return f"]({PAGES.get(match[2], match[2])}"


def _into_the_site(match):
    return f"]({PAGES[match[1]]}"


def _names():
    """Sections of the library's names, as the comments of its stubs have them, each with its docstring's place."""
    for package in ("trackvib_sim", "trackvib_sim.rui"):
        heading = ""
        for line in Path(find_spec(package).origin).with_suffix(".pyi").read_text(encoding="utf-8").splitlines():
            if line.startswith("# "):
                heading = f"\n## {package}: {line.removeprefix('# ')}\n"
            elif found := EXPORTED.match(line):
                yield f"{heading}\n::: {package}{found[1]}.{found[2]}\n"
                heading = ""
    from mr_mount_controller import laws

    yield "\n## mr_mount_controller.laws\n"
    for name in laws.__all__:
        yield f"\n::: {getattr(laws, name).__module__}.{name}\n"
