"""Long runs of the closed loop on a busy machine; not one sample, answer or mount state may be missing in their bags.

    ./trackvib exec -- python bench/long_run.py
    ./trackvib exec -- python bench/long_run.py --runs 1 --duration 60 --load 0

Each run is `trackvib run`, beside processes that do nothing but compute. Its bag is counted against what the simulator
counted, and verified by `trackvib replay --verify`.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import click
from machine import busy, machine
from trackvib_sim.analysis.completeness import missing
from trackvib_sim.bags.reading import read_recording

CLI = (sys.executable, "-m", "trackvib_sim.cli")


def row(number, folder, took):
    """Count what a bag holds; return a row of the table and what is missing."""
    recording = read_recording(folder / "bag")
    told = recording.diagnostics
    held = (len(part.stamp) for part in (recording.chassis, recording.powertrain, recording.mounts))
    cells = (
        number, f"{took:.0f} s", told["real_time_factor"], *held, told["accepted"], len(recording.answers.sample_stamp),
        told["silent_periods"],
    )  # fmt: skip
    return "| " + " | ".join(map(str, cells)) + " |", missing(recording)


@click.command(help=__doc__.splitlines()[0])
@click.option("--runs", type=click.IntRange(1), default=3, show_default=True)
@click.option("--duration", default=600.0, show_default=True, help="Simulated seconds of each run.")
@click.option("--load", type=click.IntRange(0), default=2, show_default=True, help="Processes that compute beside it.")
@click.option("--one-process/--four-processes", default=True, show_default=True)
def main(runs, duration, load, one_process):
    print(machine())
    print("| run | took | x real time | chassis/imu | powertrain/imu | mount_state | answers accepted | coil_current | "
          "silent periods |\n|---|---|---|---|---|---|---|---|---|", flush=True)  # fmt: skip
    failures = []
    for number in range(1, runs + 1):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary) / "run"
            command = [*CLI, "run", "--duration", str(duration), "--law", "skyhook", "--out", str(folder)]
            began = time.monotonic()
            with busy(load):
                ran = subprocess.run(command + ["--one-process"] * one_process, capture_output=True, text=True)
            took = time.monotonic() - began
            if not (folder / "summary.json").exists():
                sys.exit(ran.stdout + ran.stderr)
            line, lacking = row(number, folder, took)
            print(line, flush=True)
            verified = subprocess.run([*CLI, "replay", str(folder / "bag"), "--verify"], capture_output=True, text=True)
            print((verified.stdout + verified.stderr).strip().splitlines()[-1], flush=True)
            if ran.returncode or verified.returncode or lacking:
                failures.append(f"run {number}: exit code {ran.returncode}, missing: {', '.join(lacking) or 'nothing'}")
    if failures:
        sys.exit("\n".join(failures))


if __name__ == "__main__":
    main()
