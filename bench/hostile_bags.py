"""Damaged and hostile bags by the thousand: what every verb and the player do with them, in bounded memory and time.

    ./trackvib exec -- python bench/hostile_bags.py --count 3000 --seed 1 [--bag BAG]

First bags with up to three flipped bits and a cut, in process: repair must keep every message of every chunk whose
bytes are intact. Then every hostile kind through `bag info`, `bag repair`, `analyze`, `replay --verify`, `replay --law`
and the player, each in a process of its own: one clear error or success, no traceback, no control character, nothing
overwritten, at most 1 GB and 60 s. Ends with exit code 1 if anything is wrong. `--bag` is a bag of a run, from which
odd folders are made; without it they hold a small bag.
"""

import argparse
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from machine import machine
from rich.console import Console
from rich.table import Table
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.mcap_summary import examine
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.repair import repair

sys.path.append(str(Path(__file__).parents[1] / "ros2_ws" / "src" / "trackvib_sim" / "test" / "bags"))
import hostile_bags as made

MEMORY, PATIENCE = 1_000_000, 60.0  # kB, s
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
CONTROL = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


def messages(bag):
    """Return the messages of a bag with their numbers."""
    records = (record for record in raw_records(bag) if isinstance(record, RawMessage))
    return Counter(record.message.data for record in records if record.message is not None)


def flipped(count, seed):
    """Yield what is wrong, "" if nothing, for so many damaged bags."""
    chance = random.Random(seed)
    kinds = [made.sound_file(kind, sums) for kind in made.COMPRESSIONS for sums in (True, False)]
    sound = [(data, made.chunks_of(data)) for data in kinds]
    for _ in range(count):
        data, chunks = chance.choice(sound)
        edges = [edge + offset for chunk in chunks for edge in chunk[:2] for offset in range(60)]
        places = [
            chance.choice((chance.choice(edges), chance.randrange(len(data)))) for _ in range(chance.randint(0, 3))
        ]
        flips = [(place, chance.randrange(8)) for place in places]
        size = chance.choice((len(data), chance.randrange(100, len(data))))
        with tempfile.TemporaryDirectory() as folder:
            bag = Path(folder)
            (bag / made.NAME).write_bytes(made.damaged(data, flips, size))
            try:
                before = messages(bag)
                repair(bag)
                lost = (Counter(made.intact_messages(chunks, flips, size)) | before) - messages(bag)
                flaw = examine(bag / made.NAME).flaw
            except BagError as error:
                lost, flaw = {}, str(error)
        yield f"flips {flips}, size {size}: lost {sum(lost.values())}, {flaw}" if lost or flaw else ""


def verb_on(verb, bag, folder):
    """Run a verb on a bag; returns what is wrong, "" if nothing."""
    with (folder / "said").open("w+b") as said:
        began, late = time.monotonic(), False
        process = subprocess.Popen(
            VERBS[verb](str(bag), str(folder / "out")), stdin=subprocess.DEVNULL, stdout=said, stderr=said, cwd=folder
        )
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if not late and verb == "player" and b"waiting for" in (folder / "said").read_bytes():
                process.send_signal(2)
                late = None  # asked to end
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
        (CONTROL.search(text), "control character"),
        (process.returncode < 0, f"signal {-process.returncode}"),
    ]
    return ", ".join(words for is_so, words in wrong if is_so)


def hostile(bag):
    """Yield verb, kind and what is wrong, "" if nothing, for every hostile bag."""
    with tempfile.TemporaryDirectory() as place:
        sound = made.sound_file() if bag is None else next(Path(bag).glob("*.mcap")).read_bytes()
        for verb in VERBS:
            folder = Path(place) / verb
            folder.mkdir()
            for name, data in made.files():
                file = folder / "bag" / made.NAME
                file.parent.mkdir()
                file.write_bytes(data)
                yield verb, name, verb_on(verb, file.parent, folder)
                shutil.rmtree(file.parent)
                shutil.rmtree(folder / "out", ignore_errors=True)
            (folder / "odd").mkdir()
            for name, odd, victim in made.odd_folders(folder / "odd", sound):
                wrong = verb_on(verb, odd, folder)
                yield verb, name, wrong or ("" if victim.read_text() == "precious" else "overwritten")
                shutil.rmtree(folder / "out", ignore_errors=True)


def main():
    """Print the table; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000, help="damaged bags")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bag", help="bag of a run")
    choices = parser.parse_args()
    runs, right, wrongs = Counter(), Counter(), []
    results = [("repair, in process", "flipped bits", wrong) for wrong in flipped(choices.count, choices.seed)]
    for verb, kind, wrong in (*results, *hostile(choices.bag)):
        runs[verb] += 1
        right[verb] += not wrong
        if wrong:
            wrongs.append(f"{verb}, {kind!r}: {wrong}")
    table = Table("", "bags", "right", title=f"{machine()}; seed {choices.seed}")
    for verb, count in runs.items():
        table.add_row(verb, str(count), str(right[verb]))
    Console().print(table)
    for line in wrongs:
        print(line)
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(f"most memory of a process: {largest // 1000} MB")
    return 1 if wrongs else 0


if __name__ == "__main__":
    sys.exit(main())
