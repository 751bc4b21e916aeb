"""How a stage of the set-up is done: one at a time, with a line on the terminal, a log file and a stamp at the end."""

import contextlib
import fcntl
import hashlib
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from pathlib import Path

from environment import SetupError

_STAMP = "trackvib-stamp.json"
_TAIL = 30  # lines of a failed step's output that are shown
_GRACE = 10.0  # seconds an interrupted step has to clean up after itself


def say(text: str, end: str = "\n") -> None:
    """Print for the user; on stderr, because stdout belongs to the job."""
    sys.stderr.write(f"trackvib: {text}{end}")  # at one go: others at work speak, too
    sys.stderr.flush()


@contextlib.contextmanager
def only_one(lock: Path):
    """Hold the lock file; wait, and say so, while another set-up holds it. Yields its file descriptor.

    Steps inherit the descriptor: should this process be killed, a step that is left over still holds the lock, so
    that nobody wipes what it is writing to.
    """
    lock.parent.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("another set-up is running in this checkout; waiting for it ...")
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield descriptor
    finally:
        os.close(descriptor)


def fingerprint(value) -> str:
    """Hash of anything that JSON can hold."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def hash_of(path: Path) -> str | None:
    """Hash of a file's contents, None if there is none (a dangling link, a file that is gone again)."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None


def read_stamp(folder: Path) -> dict | None:
    """What `write_stamp` left in `folder`, or None if the stage was never finished."""
    try:
        return json.loads((folder / _STAMP).read_text())
    except (OSError, ValueError):
        return None


def write_stamp(folder: Path, stamp: dict) -> None:
    """Declare the contents of `folder` complete; survives a power cut only together with them."""
    os.sync()
    draft = folder / (_STAMP + ".draft")
    with open(draft, "w") as file:
        json.dump(stamp, file)
        file.flush()
        os.fsync(file.fileno())
    os.replace(draft, folder / _STAMP)


def wipe(folder: Path) -> None:
    """Make `folder` an empty folder. It is renamed first, so that there is no moment with half of it."""
    with contextlib.suppress(FileNotFoundError):
        folder.rename(folder.with_name(f"{folder.name}.old{time.time_ns()}"))
    for rubbish in folder.parent.glob(f"{folder.name}.old*"):
        shutil.rmtree(rubbish, ignore_errors=True)
    folder.mkdir()


_STOPPED = threading.Event()  # set when what runs side by side shall end


def side_by_side(jobs: dict) -> None:
    """Do jobs at the same time; what one raises, or an interrupt, ends all.

    `jobs` has, by name, the name of the job before (None for none), which stands earlier, and a call without arguments.
    """
    futures = {}

    def do(before, job):
        if before is not None:
            futures[before].result()
        job()

    with ThreadPoolExecutor(len(jobs)) as pool:
        for name, (before, job) in jobs.items():
            futures[name] = pool.submit(do, before, job)
        try:
            done, _ = wait(futures.values(), return_when=FIRST_EXCEPTION)
            for future in done:
                future.result()
        finally:
            _STOPPED.set()  # those that are done do not mind


class Task:
    """The commands of one stage: one line on the terminal, one log file."""

    _at_work = []  # tasks, side by side

    def __init__(self, what: str, takes: str, log: Path, keep: tuple = ()):
        """`what` is done, `takes` says roughly how long; `keep` are file descriptors that the commands inherit."""
        self._what = what
        self._line = f"{what}, {takes} ..."
        self._log = log
        self._keep = keep
        self._began = time.monotonic()
        self._live = sys.stderr.isatty()
        log.parent.mkdir(parents=True, exist_ok=True)
        log.write_bytes(b"")

    def __enter__(self):
        self._at_work.append(self)
        if not self._live:
            say(self._line)
        return self

    def __exit__(self, *_):
        if self._live:
            self._show(end="\n")
        self._at_work.remove(self)

    def run(self, command: list, env: dict, own_group: bool = True) -> None:
        """Run `command` into the log file. Raises SetupError, with the end of the log, if it fails.

        A process group of its own lets an interrupt end all that the command started; sudo, which asks about the
        terminal, has to stay in ours.
        """
        with open(self._log, "ab") as log:
            log.write(f"+ {shlex.join(command)}\n".encode())
            log.flush()
            process = subprocess.Popen(
                command, env=env, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                pass_fds=self._keep, preexec_fn=os.setpgrp if own_group else None,
            )  # fmt: skip
            try:
                self._wait(process)
            except BaseException:
                _stop(process, own_group)
                raise
        if process.returncode:
            raise SetupError(self._failure(process.returncode))

    def _wait(self, process) -> None:
        while True:
            if self._live and self._at_work[0] is self:
                self._show()
            try:
                process.wait(timeout=1.0)
                return
            except subprocess.TimeoutExpired:
                if _STOPPED.is_set():
                    raise SetupError(f"not finished: {self._what}") from None

    def _show(self, end: str = "") -> None:
        """Write the line anew; a terminal has one that moves, so that others at work share it."""
        others = [task._what for task in self._at_work if task is not self and not end]
        beside = f" (beside it: {', '.join(others)})" if others else ""
        print("\r\033[K", end="", file=sys.stderr)
        say(f"{self._line} {time.monotonic() - self._began:.0f} s{beside}", end=end)

    def _failure(self, code: int) -> str:
        tail = "\n".join(self._log.read_text(errors="replace").splitlines()[-_TAIL:])
        return f"failed with exit code {code}: {self._what}. Its last lines:\n{tail}\nAll of them: {self._log}"


def _stop(process, group: bool) -> None:
    """End `process`, or all of its group, gently at first."""

    def send(number):
        os.killpg(process.pid, number) if group else process.send_signal(number)

    with contextlib.suppress(ProcessLookupError, PermissionError):
        send(signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_GRACE)
        send(signal.SIGKILL)
    process.wait()
