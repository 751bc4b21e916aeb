"""The processes of a launch file: started, heard, ended in order."""

import os
import signal
import subprocess
import sys
import threading
import time
from queue import Empty, Queue

from mr_mount_controller.node_base.plain_text import readable
from trackvib_sim.nodes.forked_node import end_with_parent

from launch import LaunchError

_ESCALATION = ((0.0, signal.SIGINT), (5.0, signal.SIGTERM), (10.0, signal.SIGKILL))  # s after the wish to stop
_TICK = 0.1  # s


class _Process:
    """One that runs; its output comes line by line through a queue."""

    def __init__(self, action, name, words, process, queue):
        self.action, self.name, self.words, self.process = action, name, words, process
        self.sent = 0  # how many signals of the escalation
        threading.Thread(target=self._read, args=(queue,), daemon=True).start()

    def _read(self, queue):
        for each in self.process.stdout:
            queue.put((self, each.decode(errors="replace").rstrip("\n")))
        self.process.wait()
        queue.put((self, None))


class Processes:
    """Starts processes, prints what they print, and tells the handlers of the launch file when they end."""

    def __init__(self):
        self._running, self._count, self._queue = [], 0, Queue()
        self._stopped = None  # since when everything shall end
        self._interrupts, self._died = [], False
        self._files = []  # to be removed at the end

    def start(self, action, name, words, environment, folder):
        """Start the process of an action."""
        self._count += 1
        name = f"{name}-{self._count}"
        try:
            process = subprocess.Popen(
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                cwd=folder,
                env={**os.environ, **environment},
                start_new_session=True,  # so that Ctrl-C reaches it once, from here
                preexec_fn=end_with_parent,
            )
        except OSError as error:
            raise LaunchError(f"cannot run {words[0]}: {error.strerror}") from None
        self._running.append(_Process(action, name, words, process, self._queue))
        self.say("INFO", name, f"process started with pid [{process.pid}]")

    def leave(self, path):
        """Remove a file at the end."""
        self._files.append(path)

    def stop(self, reason):
        """Ask all to end."""
        if self._stopped is None:
            self._stopped = time.monotonic()
            self.say("INFO", "launch", f"shutting down: {reason}")

    def run(self, context):
        """Go on until all have ended; returns the exit code."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda number, _: self._interrupts.append(number))
        while self._running:
            self._look(context)
        for handler in context.handlers:
            handler.shut_down(context)
        return int(self._died)

    def close(self):
        """End at once what still runs, as after an error, and leave nothing behind."""
        for each in self._running:
            each.process.kill()
        for path in self._files:
            path.unlink(missing_ok=True)

    def say(self, level, who, text):
        """Print a line of launch's own."""
        stream = sys.stderr if level == "ERROR" else sys.stdout
        print(f"[{level}] [{readable(who)}]: {readable(text)}", file=stream, flush=True)

    def _look(self, context):
        if self._interrupts:
            number = self._interrupts.pop()
            self.say("WARNING", "launch", f"user interrupted with {'ctrl-c (SIGINT)' if number == 2 else 'SIGTERM'}")
            self.stop("interrupted")
        if self._stopped is not None:
            self._escalate()
        try:
            each, text = self._queue.get(timeout=_TICK)
        except Empty:
            return
        if text is not None:
            print(f"[{readable(each.name)}] {readable(text)}", flush=True)
            return
        self._running.remove(each)
        code = each.process.returncode
        if code == 0:
            self.say("INFO", each.name, f"process has finished cleanly [pid {each.process.pid}]")
        else:
            self._died |= self._stopped is None
            what = f"pid {each.process.pid}, exit code {code}, cmd '{' '.join(each.words)}'"
            self.say("ERROR", each.name, f"process has died [{what}].")
        if self._stopped is None:
            context.visit(each.action.on_exit)
            for handler in list(context.handlers):
                handler.process_ended(context, each.action)

    def _escalate(self):
        passed = time.monotonic() - self._stopped
        for each in self._running:
            while each.sent < len(_ESCALATION) and passed >= _ESCALATION[each.sent][0]:
                number = _ESCALATION[each.sent][1]
                self.say("INFO", each.name, f"sending signal '{number.name}' to process[{each.name}]")
                each.process.send_signal(number)
                each.sent += 1
