"""`trackvib view`, as a user calls it: pictures, recordings, what is refused.

All but the animated picture needs the viewer, which `./trackvib setup --view` installs.
"""

import os
import re
import signal
import subprocess
import time
from http.client import HTTPConnection
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from .processes import PATIENCE
from .view_helpers import CHASSIS, POWERTRAIN, ROAD, TYRE, near, needs_viewer

pytestmark = pytest.mark.system


@pytest.fixture
def view(start_cli, recorded_run):
    """Run `trackvib view` on the recorded bag, or another one, to its end: exit code and output."""

    def make(*arguments, bag=recorded_run / "bag"):
        process = start_cli("view", bag, *arguments)
        return process.wait(), process.output

    return make


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
