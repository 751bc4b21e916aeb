"""Property: what the operating system says of a process that takes up priority and core, stands back or is punctual."""

import json
import subprocess
import sys

import pytest

pytestmark = pytest.mark.property

_PROGRAM = """
import json, os, resource, sys, threading
from mr_mount_controller.node_base.parameters import ParameterError
from mr_mount_controller.node_base.scheduling import schedule
priority, core, lowly = json.loads(sys.argv[1])
core = min(os.sched_getaffinity(0)) if core is None else core
threading.Thread(target=threading.Event().wait, daemon=True).start()  # as DDS has made some already
if lowly:
    resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
    if os.geteuid() == 0:
        os.setuid(65534)
try:
    schedule({"realtime_priority": priority, "core": core})
except ParameterError as error:
    print(json.dumps(str(error)))
else:
    threads = [int(each) for each in os.listdir("/proc/self/task")]
    of_each = [
        (os.sched_getscheduler(each), os.sched_getparam(each).sched_priority, sorted(os.sched_getaffinity(each)))
        for each in threads
    ]
    print(json.dumps([core, os.SCHED_FIFO, of_each]))
"""


def scheduled(priority=0, core=-1, lowly=False):
    """What a process of its own says after `schedule`; a core of None is the first it may use."""
    told = json.dumps([priority, core, lowly])
    return json.loads(subprocess.run([sys.executable, "-c", _PROGRAM, told], capture_output=True, check=True).stdout)


def test_by_default_nothing_changes():
    """No priority in real time, and every core as before."""
    _, fifo, threads = scheduled()
    assert len(threads) == 2
    assert all(policy != fifo and priority == 0 for policy, priority, _ in threads)


def test_every_thread_keeps_to_the_core():
    core, _, threads = scheduled(core=None)
    assert [cores for _, _, cores in threads] == [[core], [core]]


def test_every_thread_runs_in_real_time():
    said = scheduled(priority=7)
    if isinstance(said, str):
        pytest.skip("real time is not allowed to whoever runs this test")
    _, fifo, threads = said
    assert [thread[:2] for thread in threads] == [[fifo, 7], [fifo, 7]]


def test_who_stands_back_does_so_with_every_thread():
    """Nicer by ten than before, and in no hurry when woken."""
    program = """
import os, threading
from mr_mount_controller.node_base.scheduling import stand_back
threading.Thread(target=threading.Event().wait, daemon=True).start()
before = os.getpriority(os.PRIO_PROCESS, 0)
stand_back()
for thread in map(int, os.listdir("/proc/self/task")):
    batch = os.sched_getscheduler(thread) == os.SCHED_BATCH
    print(batch, os.getpriority(os.PRIO_PROCESS, thread) - before)
"""
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True, text=True).stdout
    assert said.splitlines() == ["True 10", "True 10"]


def test_who_wakes_on_time_is_not_kept_waiting():
    """The kernel may delay its wake-ups by 1 ns; by more before."""
    program = """
import threading
from pathlib import Path
from mr_mount_controller.node_base.scheduling import wake_on_time
own = Path("/proc/self/timerslack_ns")
before = own.read_text()
wake_on_time()
print(int(before) > 1, own.read_text().strip())
"""
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True, text=True).stdout
    assert said.split() == ["True", "1"]


def test_what_is_not_allowed_is_told_with_a_hint():
    said = scheduled(priority=7, lowly=True)
    assert "'realtime_priority' is 7" in said and "ulimit -r" in said


def test_a_core_that_is_not_there_is_refused():
    said = scheduled(core=1023)
    assert "'core' is 1023" in said and "accepted on this machine is -1 or one of 0" in said
