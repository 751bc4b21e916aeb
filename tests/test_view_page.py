"""`trackvib view` as a page: served on loopback only, and drawn by a real browser.

It needs the viewer, which `./trackvib setup --view` installs, and Chromium or Chrome with its chromedriver.
"""

import io
import json
import os
import re
import shutil
import signal
import time
from http.client import HTTPConnection
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

from .processes import PATIENCE
from .view_helpers import CHASSIS, POWERTRAIN, ROAD, TYRE, near, needs_viewer

pytestmark = pytest.mark.system
DRAWING = 600.0  # s that a browser without a graphics card may take; only a bound for what hangs
FLAGS = ("--headless=new", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--window-size=1000,640", "--disable-background-networking",
         "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1")  # fmt: skip


@pytest.fixture
def served(start_cli, recorded_run):
    """A served view: its process and its port."""
    process = start_cli("view", recorded_run / "bag", "--start", 2.0, "--end", 3.2, "--rate", 25)
    process.wait_for("Ctrl-C ends the view")
    return process, int(re.search(r"http://127\.0\.0\.1:(\d+)/", process.output)[1])


@needs_viewer
@pytest.mark.slow(reason="drives a run again")
def test_served_on_loopback_only(served):
    """Nobody else can reach it, no other name leads to it, and its policy lets a page ask nobody else."""
    process, port = served
    inodes = {os.readlink(path) for path in Path(f"/proc/{process.pid}/fd").iterdir() if path.exists() or True}
    listening = [
        line.split()
        for table in ("tcp", "tcp6")
        for line in Path(f"/proc/{process.pid}/net/{table}").read_text().splitlines()[1:]
    ]
    own = [row[1] for row in listening if row[3] == "0A" and f"socket:[{row[9]}]" in inodes]
    assert own == [f"0100007F:{port:04X}"]
    answers = {}
    for path, host in (("/", f"127.0.0.1:{port}"), ("/", "evil.example"), ("/pieces/x", f"127.0.0.1:{port}"),
                       ("/../cli.py", f"127.0.0.1:{port}"), ("/pieces/1", f"localhost:{port}")):  # fmt: skip
        connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
        connection.request("GET", path, headers={"Host": host})
        answer = connection.getresponse()
        answers[path, host] = answer.status
        policy = answer.getheader("Content-Security-Policy")
        assert "connect-src 'self';" in policy and "default-src 'none'" in policy
        connection.close()
    assert list(answers.values()) == [200, 403, 404, 404, 410]
    process.signal(signal.SIGINT)
    assert process.wait() == 0 and process.output.endswith("the view has ended\n")


@needs_viewer
@pytest.mark.slow(reason="a browser draws without a graphics card")
def test_page_in_a_browser(served):
    """Vehicle, road and curves are drawn; no request leaves for anywhere else, and none could."""
    programs = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome", "chrome"))
    program, driver = next(filter(None, programs), None), shutil.which("chromedriver")
    if not (program and driver):
        pytest.skip("no Chromium or Chrome with chromedriver on this machine: apt-get install chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location, options.page_load_strategy = program, "none"
    options.set_capability("goog:loggingPrefs", {"performance": "ALL"})
    for word in (*FLAGS, *(["--no-sandbox"] if os.geteuid() == 0 else [])):
        options.add_argument(word)
    browser = webdriver.Chrome(options=options, service=Service(driver))
    try:
        browser.command_executor.client_config.timeout = DRAWING
        browser.set_script_timeout(DRAWING)
        _, port = served
        browser.get(f"http://127.0.0.1:{port}/?renderer=webgl")
        end, seen = time.monotonic() + DRAWING, {}
        while not (seen and all(seen.values())):
            assert time.monotonic() < end, f"not drawn: {seen}"
            time.sleep(1.0)
            picture = np.asarray(Image.open(io.BytesIO(browser.get_screenshot_as_png())).convert("RGB"))
            left, right = np.split(picture, [int(0.63 * picture.shape[1])], axis=1)
            seen = {
                "vehicle": near(left, TYRE, 25) > 1000,
                "road": near(left, ROAD, 40) > 5000,
                "chassis": near(right, CHASSIS, 40) > 100,
                "powertrain": near(right, POWERTRAIN, 40) > 100,
            }
        events = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
        sent = [each["params"]["request"]["url"] for each in events if each["method"] == "Network.requestWillBeSent"]
        assert any(url.endswith("/pieces/0") for url in sent)
        ours = (f"http://127.0.0.1:{port}/", "data:", "blob:")
        assert [url for url in sent if not url.startswith(ours)] == []
        outcome = browser.execute_async_script(
            "const done = arguments[0]; addEventListener('securitypolicyviolation', e => done(e.violatedDirective));"
            "fetch('http://127.0.0.1:9/').catch(() => {})"
        )
        assert outcome == "connect-src"
    finally:
        browser.quit()
