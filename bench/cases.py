"""What a case of a study costs beside its physics: start of the workers, hand-over, filters and store.

    ./trackvib exec -- python bench/cases.py [--cases 10000]

Cases of 2 s of the default vehicle, each on a road of its own, go to one Dask worker a core as in every study. Beside
them, before and after, drives go to one bare process a core, which counts physics alone: a core is slower where the
others work as well. Processor time is compared.
"""

import argparse
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path
from statistics import mean

import psutil
import trackvib_sim as tv
from dask.system import CPU_COUNT
from machine import machine
from rich.console import Console
from rich.progress import Progress
from trackvib_sim.studies import case
from trackvib_sim.studies.case_store import CaseStore
from trackvib_sim.studies.run_missing import run_missing
from trackvib_sim.vehicle.vehicle_file import read_vehicle

DURATION = 2.0  # s measured, after settling
ALONE = 12 * CPU_COUNT  # drives of physics alone, before and after


def drive(vehicle, wanted):
    """As `studies.case.drive`, but for two seconds."""
    return case.drive(vehicle, wanted, DURATION)


def cases(count):
    """So many cases on roads of class C at 10 m/s."""
    return [case.Case("C", 10.0, seed, 0.3) for seed in range(1, count + 1)]


def physics(vehicle, wanted):
    """Return the processor time [s] of a case's run alone, its road's heights included."""
    simulation, road = case.prepare(vehicle, wanted)
    periods = round((case.settling(wanted.speed) + DURATION) * case.RATES.control)
    began = time.process_time()
    tv.run_open_loop(simulation, road, periods)
    return time.process_time() - began


def on_all_cores(vehicle, first, cases):
    """Return `physics` of each case, in one bare process a core; each has driven a first one before them."""
    with ProcessPoolExecutor(CPU_COUNT, initializer=physics, initargs=(vehicle, first)) as bare:
        return [*bare.map(physics, repeat(vehicle), cases)]


def main():
    """Drive, count, print."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--cases", type=int, default=200)
    count = arguments.parse_args().cases
    file = Path(tv.find_vehicle())
    vehicle, _ = read_vehicle(file)
    *before, first = cases(ALONE + 1)
    after = cases(2 * ALONE + 1)[ALONE + 1 :]  # other roads: heights once computed are kept
    alone = on_all_cores(vehicle, first, before)
    with tempfile.TemporaryDirectory() as folder, Progress(console=Console(stderr=True)) as progress:
        store = CaseStore(folder, file.read_text(encoding="utf-8"))
        already, began = processor_time(), time.monotonic()
        found = run_missing(vehicle, cases(count), store, None, progress, "cases", drive)
        took, spent = time.monotonic() - began, processor_time() - already
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
    alone += on_all_cores(vehicle, first, after)
    assert len(found) == count and all(result.status == case.GOOD for result in found.values())
    print(f"{count} cases of {DURATION:g} s, {machine()}")
    print(f"a case: {spent / count:.3f} s of processor, its physics {mean(alone):.3f} s,"
          f" ratio {spent / count / mean(alone):.2f}")  # fmt: skip
    print(f"all: {took:.0f} s, {size / count:.0f} bytes a case in the store,"
          f" {psutil.Process().memory_info().rss / 1e6:.0f} MB in the study's process")  # fmt: skip


def processor_time():
    """Return what this process and all that it has ever started have taken [s], whether they have ended or not."""
    own = psutil.Process()
    return sum(sum(process.cpu_times()[:4]) for process in (own, *own.children(recursive=True)))


if __name__ == "__main__":
    main()
