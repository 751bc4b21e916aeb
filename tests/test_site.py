"""`./trackvib docs`: the documents as a site, built with strict links, and shown on this machine only.

Its generator is installed by `./trackvib setup --docs`.
"""

import re
import socket
import sys
from importlib.util import find_spec
from urllib.request import urlopen

import html5lib
import pytest

from .documents import ROOT

pytestmark = [
    pytest.mark.system,
    pytest.mark.slow(reason="builds the whole site"),
    pytest.mark.skipif(not find_spec("mkdocs"), reason="no mkdocs here: ./trackvib setup --docs"),
]
COMMAND = (sys.executable, ROOT / "docs" / "show_site.py")
LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}  # by a page, unasked
PAGES = ("index", "contributing", "changelog", "api", "command_line", "messages", "nodes", "credibility")


@pytest.fixture
def site(start, tmp_path):
    """A folder with the built site."""
    process = start([*COMMAND, "--build", tmp_path / "site"])
    assert process.wait() == 0, process.output
    return tmp_path / "site"


def test_site_is_whole_and_fetches_nothing(site, start):
    """Links are sound, every page is there, none loads anything from elsewhere; a folder is not built over."""
    for page in PAGES:
        assert (site / ("index.html" if page == "index" else f"{page}/index.html")).is_file(), page
    for path in site.rglob("*.html"):
        tree = html5lib.parse(path.read_text(encoding="utf-8"), namespaceHTMLElements=False)
        for name, attribute in LOADED.items():
            for element in tree.iter(name):
                assert ":" not in element.get(attribute, "").split("#")[0], f"{path}: {element.attrib}"
    for sheet in site.rglob("*.css"):
        assert not re.search(r"url\([\"']?(?:https?:)?//|@import", sheet.read_text(encoding="utf-8")), sheet
    commands = (site / "command_line" / "index.html").read_text(encoding="utf-8")
    assert "--largest-chunk" in commands and "study resistance" in commands
    names = (site / "api" / "index.html").read_text(encoding="utf-8")
    for name in ("read_vehicle", "run_closed_loop", "natural_frequencies", "ControlLaw"):
        assert f">{name}<" in names or f"{name}</" in names, name
    again = start([*COMMAND, "--build", site])
    assert again.wait() == 1 and "already exists" in again.output


def test_site_is_shown_on_loopback(start):
    """The site answers on 127.0.0.1, and on no other address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    process = start([*COMMAND, "--port", port])
    process.wait_for(f"Serving on http://127.0.0.1:{port}/")
    with urlopen(f"http://127.0.0.1:{port}/", timeout=60) as page:
        assert b"trackvib" in page.read()
    with pytest.raises(OSError, match="refused"), socket.create_connection(("127.0.0.2", port), timeout=5):
        pass
