"""`trackvib view`, as a user calls it: pictures, recordings, what is refused; and the page in a real browser.

The page needs Chromium or Chrome with its chromedriver on the machine, all but the animated picture the viewer, which
`./trackvib setup --view` installs.
"""

import io
import json
import os
import re
import shutil
import signal
import subprocess
import time
from http.client import HTTPConnection
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

from .processes import PATIENCE

pytestmark = pytest.mark.system
needs_viewer = pytest.mark.skipif(not find_spec("rerun"), reason="no rerun-sdk here: ./trackvib setup --view")
DRAWING = 600.0  # s that a browser without a graphics card may take; only a bound for what hangs
TYRE, ROAD, CHASSIS, POWERTRAIN = (84, 92, 99), (176, 162, 137), (59, 110, 165), (209, 102, 43)
FLAGS = ("--headless=new", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--window-size=1000,640", "--disable-background-networking",
         "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1")  # fmt: skip


@pytest.fixture
def view(start_cli, recorded_run):
    """Run `trackvib view` on the recorded bag, or another one, to its end: exit code and output."""

    def make(*arguments, bag=recorded_run / "bag"):
        process = start_cli("view", bag, *arguments)
        return process.wait(), process.output

    return make


@pytest.fixture
def served(start_cli, recorded_run):
    """A served view: its process and its port."""
    process = start_cli("view", recorded_run / "bag", "--start", 2.0, "--end", 3.2, "--rate", 25)
    process.wait_for("Ctrl-C ends the view")
    return process, int(re.search(r"http://127\.0\.0\.1:(\d+)/", process.output)[1])


def near(picture, colour, distance):
    """How many pixels (h, w, 3) are of about a colour."""
    return int((np.abs(picture.astype(int) - colour).max(axis=-1) < distance).sum())


@pytest.mark.slow(reason="drives a run again and draws it")
def test_animated_picture(view, tmp_path):
    """Few bytes, as many frames as asked for; vehicle, road and curves are on it, and it moves."""
    code, output = view("--gif", tmp_path / "run.gif", "--start", 2.0, "--end", 2.8)
    assert code == 0, output
    with Image.open(tmp_path / "run.gif") as picture:
        frames = []
        for number in range(picture.n_frames):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGB")))
    assert len(frames) == 11 and (tmp_path / "run.gif").stat().st_size < 1e6
    upper, lower = np.split(frames[5], [330])
    assert near(upper, TYRE, 40) > 2000 and near(upper, ROAD, 40) > 5000
    assert near(lower, CHASSIS, 40) > 100 and near(lower, POWERTRAIN, 40) > 20
    assert (frames[5][:330] != frames[4][:330]).any(axis=-1).mean() > 0.02
    assert list(tmp_path.glob("*.part*")) == []


@needs_viewer
@pytest.mark.slow(reason="drives a run again")
def test_saved_recording(view, tmp_path):
    """Rerun's own program finds it sound, with every kind of entity in it."""
    code, output = view("--save", tmp_path / "run.rrd", "--start", 2.0, "--end", 3.2)
    assert code == 0 and "61 frames" in output, output
    program = Path(find_spec("rerun_cli").origin).with_name("rerun")
    quiet = {**os.environ, "RERUN_ANALYTICS": "off", "HOME": str(tmp_path)}
    told = {}
    for verb in ("verify", "print"):
        done = subprocess.run([program, "rrd", verb, tmp_path / "run.rrd"], env=quiet, capture_output=True, text=True)
        told[verb] = done.stdout + done.stderr
        assert done.returncode == 0, told[verb]
    for entity in ("world/hull", "world/left_wheel_1", "world/right_arm_6", "world/left_track", "world/road",
                   "world/mounts", "world/hull/chassis_imu/acceleration", "world/follow", "coil_current/left",
                   "vertical_acceleration/chassis", "mount_force/right", "spectrum/powertrain"):  # fmt: skip
        assert f"/{entity}" in told["print"], entity


@pytest.mark.slow(reason="each case starts the command line")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--start", 2.0, "--end", 1.0), "the bag holds nothing from 2 to 1 s: it covers 0.001 to 3.2 s"),
        (("--start", 50.0), "the bag holds nothing from 50 to inf s"),
        (("--gif", "a.gif", "--rate", 1000.0, "--start", 2.5), "accepted in a picture are 400"),
        (("--gif", "a.gif", "--save", "a.rrd"), "--save and --gif cannot be combined"),
        (("--rate", 0.1), "not in the range"),
        (("--gif", "nowhere/a.gif"), "nowhere"),
    ],
)
def test_bad_choices_are_refused(view, tmp_path, arguments, words):
    """One line says what is wrong; nothing is left."""
    code, output = view(*arguments)
    assert code != 0 and words in output and "Traceback" not in output
    assert [path.name for path in tmp_path.iterdir() if not path.name.startswith("process_")] == []


@pytest.mark.slow(reason="each case starts the command line")
@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (lambda topic, data: None if topic == "/vehicle_description" else data, "holds no messages on vehicle_descrip"),
        (lambda topic, data: None if topic == "/road_profile" else data, "holds no messages on road_profile"),
        (
            lambda topic, data: data.replace(b"mass", b"m\x1b]s") if topic == "/vehicle_description" else data,
            "unacceptable character #x001b",
        ),
    ],
    ids=["no vehicle", "no road", "hostile vehicle"],
)
def test_bags_that_do_not_tell_enough(view, edited, edit, words):
    """One line says what is missing; text of a bag never comes raw."""
    code, output = view("--gif", "a.gif", bag=edited(edit))
    assert code != 0 and words in output and "\x1b" not in output and "Traceback" not in output
    assert output.count("\n") == 1


@pytest.mark.slow(reason="starts the command line")
def test_a_run_in_real_time_needs_its_poses(view, edited):
    """Such a bag without frames says how to get them."""

    def realtime(name, values):
        return {**values, "pace": "realtime"} if name == "parameters of /simulator" else values

    code, output = view("--gif", "a.gif", bag=edited(provenance=realtime))
    assert code != 0 and "holds no poses on tf and track_links" in output and "view_rate" in output


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
@pytest.mark.slow(reason="a whole run, and drives it again")
def test_run_is_shown_while_it_goes_on(start_cli, view, tmp_path):
    """Pieces of a recording come as the run goes on, and end with it; the view stays until Ctrl-C.

    Curves and spectra are those that a view of the run's bag has, from the first sample on.
    """
    run = start_cli("run", "--view", "--duration", 3.2, "--out", tmp_path / "run")
    run.wait_for("Ctrl-C ends the view")
    port = int(re.search(r"http://127\.0\.0\.1:(\d+)/", run.output)[1])
    statuses, pieces, end = [], [], time.monotonic() + PATIENCE
    while statuses[-1:] != [410]:
        assert time.monotonic() < end, statuses
        connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
        connection.request("GET", f"/pieces/{len(pieces)}")
        answer = connection.getresponse()
        statuses.append(answer.status)
        data = answer.read()
        if answer.status == 200:
            pieces.append(tmp_path / f"{len(pieces)}.rrd")
            pieces[-1].write_bytes(data)
        connection.close()
    assert len(pieces) > 2
    run.wait_for("written to")
    run.signal(signal.SIGINT)
    assert run.wait() == 0 and run.output.endswith("the view has ended\n"), run.output

    code, output = view("--save", tmp_path / "bag.rrd", bag=tmp_path / "run" / "bag")
    assert code == 0, output
    live, recorded = plotted(pieces[1:]), plotted([tmp_path / "bag.rrd"])
    assert live.keys() == recorded.keys()
    for path, (times, values) in recorded.items():
        shown = live[path][0] >= times[0]  # a bag's view begins with its first frame
        np.testing.assert_array_equal(live[path][0][shown], times, err_msg=path)
        np.testing.assert_array_equal(live[path][1][shown], values, err_msg=path)
    bars = recorded["/spectrum/chassis"][1]
    assert bars.shape[0] > 20 and (np.diff(bars, axis=0) != 0.0).any(axis=1).all()  # it moves


def plotted(files):
    """Return times (k,) [ns] and values (k, n) of every curve and spectrum in recordings, by path."""
    from rerun.chunk import RrdReader

    found, kinds = {}, {"Scalars:scalars": np.asarray, "BarChart:values": lambda bars: bars[0]["buffer"]}
    for file in files:
        for chunk in RrdReader(file).stream():
            batch = chunk.to_record_batch()
            for name in kinds.keys() & set(batch.schema.names):
                times = batch["time"].cast("int64").to_pylist()
                points = zip(times, map(kinds[name], batch[name].to_pylist()), strict=True)
                found.setdefault(chunk.entity_path, {}).update(points)
    ordered = {path: sorted(points.items()) for path, points in found.items()}
    return {path: tuple(map(np.array, zip(*points, strict=True))) for path, points in ordered.items()}


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
