"""`trackvib study table1`, as a user calls it, and Dask clusters that die under it."""

import csv
import json
import os
import signal
import sys
import time

import pytest

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="spreads drives over worker processes")

PATIENCE = 90.0
PNG = b"\x89PNG\r\n\x1a\n"
SMALL = ("--classes", "A,E", "--speeds", "20", "--seeds", 4)
RUNS = 8  # of it: the first is stored long before the last, on a busy machine as well


@pytest.fixture(autouse=True, scope="module")
def two_cores():
    """Let the test's processes have two cores at most, so that a study has more runs than workers anywhere."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(cores)[:2])
    yield
    os.sched_setaffinity(0, cores)


@pytest.fixture
def table1(start_cli):
    """Start `trackvib study table1`."""
    return lambda *arguments: start_cli("study", "table1", *arguments)


@pytest.fixture
def scheduler(start, tmp_path):
    """A Dask scheduler started by hand: its address, its process, and a function that starts a worker of it."""
    file = tmp_path / "scheduler.json"
    process = start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", 0,
                     "--no-dashboard", "--scheduler-file", file])  # fmt: skip
    wait_until(lambda: file.exists() and file.read_text(), process)
    address = json.loads(file.read_text())["address"]

    def worker():
        made = start([sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", 1, "--no-nanny"])
        made.wait_for("Registered to")
        return made

    return address, process, worker


def wait_until(condition, process):
    """Wait for a condition while a process runs."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert process.running and time.monotonic() < end, process.output
        time.sleep(0.02)


def finished(folder):
    """When each finished run of a study was written, by file name."""
    return {file.name: file.stat().st_mtime_ns for file in (folder / "cases").glob("*.json")}


def test_leaves_table_report_and_picture(table1, tmp_path, kept_cases):
    """From any directory; again with what is there already, no worker is needed and nothing is done anew."""
    run = table1("--classes", "A", "--speeds", "20", "--seeds", "1")
    assert run.wait() == 0, run.output
    assert "error factor over the paper's rows" in run.output and "calibrated without A" in run.output
    assert "calibrated without C" not in run.output
    folder = tmp_path / "table1"
    with (folder / "table1.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["road_class"], row["speed_mps"], row["status"]) == ("A", "20", "ok")
    assert len(row) == 15 and all(float(row[f"chassis_{axis}"]) > 0.1 for axis in "xyz")
    report = (folder / "table1.md").read_text()
    assert "| A | 20 |" in report and "0.5-500 Hz" in report
    assert (folder / "table1.png").read_bytes().startswith(PNG)
    before = finished(folder)
    assert len(before) == 1
    kept_cases.keep(folder, "table1")
    again = table1("--classes", "A", "--speeds", "20", "--seeds", "1", "--scheduler", "tcp://127.0.0.1:1")
    assert again.wait() == 0, again.output
    assert finished(folder) == before


@SLOW
def test_goes_on_where_it_was_interrupted(table1, tmp_path, kept_cases):
    """Ctrl-C keeps what is finished and says so in one line; the same command does the rest only."""
    folder = tmp_path / "study"
    run = table1(*SMALL, "--out", folder)
    wait_until(lambda: finished(folder), run)
    run.signal(signal.SIGINT)
    assert run.wait() == 130, run.output
    kept = finished(folder)
    assert 0 < len(kept) < RUNS, "it was not interrupted midway"
    assert f"interrupted; finished runs are kept in {folder}, the same command continues from there" in run.output
    assert "Traceback" not in run.output
    assert [path.name for path in folder.iterdir()] == ["cases"]
    again = table1(*SMALL, "--out", folder)
    assert again.wait() == 0, again.output
    assert len(finished(folder)) == RUNS
    assert finished(folder).items() >= kept.items()
    assert not [path for path in folder.rglob("*") if path.name.startswith(".")]
    kept_cases.keep(folder, "table1")


@SLOW
def test_a_full_disk_ends_the_study_in_one_line(start, tmp_path, kept_cases):
    """Files cannot grow beyond 20 kB, so the picture is not there, nor half of it; every finished run is kept."""
    command = [
        sys.executable,
        "-m",
        "trackvib_sim.cli",
        "study",
        "table1",
        "--classes",
        "A",
        "--speeds",
        5,
        "--seeds",
        1,
    ]
    run = start(["prlimit", "--fsize=20000", *command])
    assert run.wait() == 1, run.output
    folder = tmp_path / "table1"
    assert "error: [Errno 27] File too large: 'table1/table1.png'" in run.output and "Traceback" not in run.output
    assert {path.name for path in folder.iterdir()} == {"cases", "left_out", "table1.csv", "table1.md"}
    kept = finished(folder)
    assert len(kept) == len(list((folder / "cases").iterdir())) == 1
    again = start(command)
    assert again.wait() == 0, again.output
    assert finished(folder) == kept and (folder / "table1.png").exists()
    kept_cases.keep(folder, "table1")


@SLOW
def test_a_folder_that_goes_ends_the_study_in_one_line(table1, tmp_path, kept_cases):
    """Nothing is made in its old place; the runs that it holds are whole."""
    run = table1(*SMALL)
    wait_until(lambda: finished(tmp_path / "table1"), run)
    (tmp_path / "table1").rename(tmp_path / "elsewhere")
    assert run.wait() == 1
    assert run.output.count("error: ") == 1 and "No such file or directory: 'table1/cases/" in run.output
    assert "Traceback" not in run.output and not (tmp_path / "table1").exists()
    kept = finished(tmp_path / "elsewhere")
    kept_cases.give(tmp_path / "elsewhere", "table1")
    again = table1(*SMALL, "--out", "elsewhere")
    assert again.wait() == 0, again.output
    assert finished(tmp_path / "elsewhere").items() >= kept.items()


@SLOW
def test_a_killed_worker_changes_nothing(table1, scheduler, tmp_path, kept_cases):
    """A cluster of two workers, one of them killed midway, gives the table that this machine alone gives."""
    kept_cases.give(tmp_path / "cluster", "table1", ("left_out",))  # which do not count in the table
    address, process, worker = scheduler
    workers = [worker(), worker()]
    run = table1(*SMALL, "--out", tmp_path / "cluster", "--scheduler", address)
    wait_until(lambda: finished(tmp_path / "cluster"), run)
    os.kill(workers[0].pid, signal.SIGKILL)
    assert len(finished(tmp_path / "cluster")) < RUNS, "it was not killed midway"
    assert run.wait() == 0, run.output
    assert not workers[0].running and workers[1].running
    kept_cases.give(tmp_path / "alone", "table1")
    alone = table1(*SMALL, "--out", tmp_path / "alone")
    assert alone.wait() == 0, alone.output
    ours, theirs = ((tmp_path / name / "table1.csv").read_bytes() for name in ("alone", "cluster"))
    assert ours == theirs
    assert len(ours.splitlines()) == 3


@SLOW
def test_a_lost_cluster_ends_the_study_in_one_line(table1, scheduler, tmp_path):
    """A scheduler without workers, and one that dies midway: an error that says so, and finished runs are kept."""
    address, process, worker = scheduler
    run = table1(*SMALL, "--scheduler", address)
    assert run.wait() == 1
    assert "error: the Dask scheduler has had no worker for 5 s\n" in run.output
    worker()
    run = table1(*SMALL, "--scheduler", address)
    wait_until(lambda: finished(tmp_path / "table1"), run)
    os.kill(process.pid, signal.SIGKILL)
    assert run.wait() == 1
    assert "error: the connection to the Dask scheduler is lost" in run.output and "Traceback" not in run.output
    assert 0 < len(finished(tmp_path / "table1")) < RUNS


@SLOW
def test_a_worker_without_the_package_is_named(table1, start, scheduler, env):
    """A worker that cannot load what it is to run is refused before anything is run."""
    address, _, worker = scheduler
    path = env.pop("PYTHONPATH")
    worker()
    env["PYTHONPATH"] = path
    run = table1(*SMALL, "--scheduler", address)
    assert run.wait() == 1
    assert "cannot load trackvib" in run.output and "No module named 'trackvib_sim'" in run.output
    assert run.output.count("\n") <= 2


@SLOW
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--classes", "A,Z"), ("--classes", "'Z'", "'A', 'B', 'C', 'D', 'E', 'F', 'G', 'H'")),
        (("--classes", ""), ("--classes", "''")),
        (("--speeds", "5,0"), ("--speeds", "0", "above 0, up to 25 m/s")),
        (("--speeds", "nan"), ("--speeds", "nan", "above 0, up to 25 m/s")),
        (("--speeds", "5;10"), ("--speeds", "5;10", "not a valid float")),
        (("--seeds", "0"), ("--seeds", "0", "1 to 1000")),
        (("--vehicle", "none.yaml"), ("error: vehicle file 'none.yaml' cannot be read",)),
        (("--scheduler", "nonsense"), ("error: no Dask scheduler answers at 'nonsense'", "tcp://host:8786")),
        (("--out", "/proc/none"), ("error:", "/proc/none")),
    ],
)
def test_bad_input_is_refused(table1, tmp_path, arguments, words):
    """The error names the item, its value and what is accepted; nothing is run or left half done."""
    run = table1(*arguments)
    assert run.wait() in (1, 2)
    output = run.output.replace("\n", " ")
    assert all(word in output for word in words), run.output
    assert "Traceback" not in output
    assert not list(tmp_path.rglob("*.csv")) and not list(tmp_path.rglob("*.json"))
