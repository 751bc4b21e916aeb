"""The report in a real browser, opened from disk: everything drawn, no error, no request, readable on a phone.

Needs Chromium or Chrome with its chromedriver on the machine (Debian and Ubuntu: `apt-get install chromium-driver`).
"""

import json
import os
import shutil

import pytest
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from trackvib_sim.analysis.report.page import write_report

from ..hostile_recordings import hostile_report_data

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="starts a browser")]

SIZES = {"desktop": (1300, 900, False), "phone": (390, 844, True)}
PATIENCE = 600.0  # s; only a bound for what hangs


@pytest.fixture(scope="module")
def browser():
    """A headless browser."""
    programs = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome", "chrome"))
    program, driver = next(filter(None, programs), None), shutil.which("chromedriver")
    if not (program and driver):
        pytest.skip("no Chromium or Chrome with chromedriver on this machine: apt-get install chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location = program
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    words = ["--headless=new", "--disable-dev-shm-usage", *(["--no-sandbox"] if os.geteuid() == 0 else [])]
    for word in words:
        options.add_argument(word)
    running = webdriver.Chrome(options=options, service=Service(driver))
    running.command_executor.client_config.timeout = PATIENCE
    yield running
    running.quit()


@pytest.fixture(scope="module", params=[1, 2])
def page(request, tmp_path_factory):
    """Address of the report on one hostile bag, and of the comparison of two."""
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report([hostile_report_data(str(number)) for number in range(request.param)], path)
    return path.as_uri()


@pytest.fixture(scope="module", params=SIZES)
def opened(request, browser, page):
    """The browser with the report open on a desktop or a phone."""
    width, height, mobile = SIZES[request.param]
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": mobile})
    for kind in ("browser", "performance"):
        browser.get_log(kind)  # forgets what was before
    browser.get(page)
    return browser


def test_report_opens_draws_and_fits(opened, page):
    """No word in the console, no request but for the file, every figure with data, nothing wider than the screen."""
    assert opened.get_log("browser") == []
    events = (json.loads(entry["message"])["message"] for entry in opened.get_log("performance"))
    asked = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
    assert page in asked
    assert [url for url in asked if url != page and not url.startswith(("data:", "blob:"))] == []
    drawn = opened.execute_script(
        "return [...document.querySelectorAll('.figure')].map(each => each.querySelectorAll("
        "'.scatterlayer .js-line[d], .heatmaplayer image, .barlayer path[d]').length)"
    )
    assert len(drawn) >= 10 and all(drawn)
    assert opened.execute_script("return window.injected") is None
    assert opened.execute_script("return document.scrollingElement.scrollWidth <= innerWidth")
    widest = "return Math.max(...[...document.querySelectorAll('.figure .main-svg')].map(each => each.clientWidth))"
    assert 0 < opened.execute_script(widest) <= opened.execute_script("return innerWidth")


def test_report_follows_a_dark_screen(opened):
    """Paper dark, words of page and figures light; and the other way round."""
    told = {}
    for scheme in ("light", "dark"):
        feature = {"name": "prefers-color-scheme", "value": scheme}
        opened.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [feature]})
        told[scheme] = opened.execute_script(
            "const of = (element, name) => getComputedStyle(element)[name].match(/[0-9]+/g).slice(0, 3).map(Number);"
            "return [of(document.body, 'backgroundColor'), of(document.body, 'color'),"
            " of(document.querySelector('.figure text'), 'fill')]"
        )
    paper, *ink = told["light"]
    assert min(paper) > 200 and all(max(colour) < 80 for colour in ink)
    paper, *ink = told["dark"]
    assert max(paper) < 80 and all(min(colour) > 200 for colour in ink)
