"""Every hostile kind of bag through every verb and the player, each in a process of its own; all are tried once.

`bag info`, `bag repair`, `analyze`, `replay --verify`, `replay --law` and the player end in one clear error or succeed:
no traceback, no control character, nothing overwritten, at most 1 GB and some 50 s.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .bags import made
from .trial import CONTROL, Wrong

REFUSALS = ()  # of processes there are but exit codes
MEMORY, PATIENCE = 1_000_000, 50.0  # kB, s
TRACKVIB = (sys.executable, "-m", "trackvib_sim.cli")
PLAYER = (sys.executable, "-c", "from trackvib_sim.nodes.player import main; main()")
VERBS = {
    "bag info": lambda bag, out: (*TRACKVIB, "bag", "info", bag),
    "bag repair": lambda bag, out: (*TRACKVIB, "bag", "repair", bag),
    "analyze": lambda bag, out: (*TRACKVIB, "analyze", bag, "--out", out),
    "replay --verify": lambda bag, out: (*TRACKVIB, "replay", bag, "--verify"),
    "replay --law": lambda bag, out: (*TRACKVIB, "replay", bag, "--law", "skyhook", "--out", out),
    "player": lambda bag, out: (*PLAYER, "--ros-args", "-p", f"bag:={bag}"),
}


def trials(chance, count):
    """Yield every pair of verb and bag, in random order; at most so many."""
    with tempfile.TemporaryDirectory() as folder:
        bags = [(name, data) for name, data in made.files()]
        (Path(folder) / "odd").mkdir()
        odd = [name for name, *_ in made.odd_folders(Path(folder) / "odd", made.sound_file())]
    pairs = [(verb, *bag) for verb in VERBS for bag in (*bags, *((name, None) for name in odd))]
    chance.shuffle(pairs)
    for verb, name, data in pairs[:count]:
        yield f"{verb}, {name!r}", lambda verb=verb, name=name, data=data: _attempt(verb, name, data)


def _attempt(verb, name, data):
    with tempfile.TemporaryDirectory() as folder:
        place, victim = Path(folder), None
        bag = place / "bag"
        bag.mkdir()
        if data is None:
            each = next(each for each in made.odd_folders(bag, made.sound_file()) if each[0] == name)
            _, bag, victim = each
        else:
            (bag / made.NAME).write_bytes(data)
        code = _verb_on(verb, bag, place)
        if victim is not None and victim.read_text() != "precious":
            raise Wrong("overwritten")
    return f"{verb}: {'done' if code == 0 else 'one error'}"


def _verb_on(verb, bag, folder):
    """Run a verb on a bag; returns its exit code."""
    with (folder / "said").open("w+b") as said:
        began, late, asked = time.monotonic(), False, False
        process = subprocess.Popen(
            VERBS[verb](str(bag), str(folder / "out")), stdin=subprocess.DEVNULL, stdout=said, stderr=said, cwd=folder
        )
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if not asked and verb == "player" and b"waiting for" in (folder / "said").read_bytes():
                process.send_signal(signal.SIGINT)
                asked = True
            if time.monotonic() - began > PATIENCE:
                process.kill()
                late = True
            time.sleep(0.02)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode(errors="replace")
    wrong = [
        (late, f"more than {PATIENCE:g} s"),
        (usage.ru_maxrss > MEMORY, f"{usage.ru_maxrss // 1000} MB"),
        ("Traceback" in text, "traceback"),
        (control := CONTROL.search(text), control and f"control character in {text[: control.end() + 80]!r:.300}"),
        (process.returncode < 0, f"signal {-process.returncode}"),
    ]
    if any(is_so for is_so, _ in wrong):
        raise Wrong(", ".join(words for is_so, words in wrong if is_so))
    return process.returncode
