"""One run of the closed loop from the command line: processes, progress, and what the bag then tells."""

import os
import re
import signal
import socket
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from datetime import datetime
from math import isfinite
from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from ..analysis.segments import SHORTEST_MEASURING
from ..analysis.settling import SHORTEST_SETTLING, VEHICLE_BEHIND, settling_time
from ..bags.errors import BagError
from ..console import Description, Terminal
from ..data import find_vehicle
from ..nodes.processes import FOUR_PROCESSES, ONE_PROCESS, LoopProcesses, closed_loop_parameters
from ..road_sources.road_file import RoadError, find_road, road_in_words, whole_name
from ..vehicle.drive.drive_file import DriveFileError, drive_text, parse_drive
from ..vehicle.drive.schedule import arrival_time
from ..vehicle.step_size import recommended_rate
from ..vehicle.vehicle_file import VehicleFileError, read_vehicle
from .result_folder import CommandError, make_folder, writing_to

HIGHEST_DOMAIN = 232  # of ROS 2; beyond it DDS has no ports
VIEW_RATE = 50  # Hz of simulated time
_LOOK = 0.2  # s between looks at processes and progress


@dataclass(frozen=True)
class Choices:
    """What the user chose."""

    vehicle: str | None  # name or file; None for the default one
    road: str  # class, or file
    speed: float
    drive: str | None  # file; then `speed` has no effect
    gears: bool
    duration: float
    law: str
    seed: int
    physics_rate: int
    one_process: bool
    measure_rate: int = 0  # Hz, of the running gear; 0 for none
    view: bool = False  # in a browser

    @property
    def title(self):
        """The run in words."""
        vehicle = f"vehicle {self.vehicle}, " if self.vehicle else ""
        drive = f"{self.speed:g} m/s" if self.drive is None else f"drive {Path(self.drive).name}"
        road = f"{road_in_words(self.road)}, {drive}{' in gears' if self.gears else ''}"
        return f"{vehicle}{road}, law {self.law}, seed {self.seed}, {self.duration:g} s"


def run_loop(choices, out, viewing=nullcontext):
    """Do a run; everything it leaves lies in one new folder, `out` or one named by time, road and speed.

    `viewing` makes a context manager for the time of the run of a vehicle (`parameters.Vehicle`), entered once its
    processes have been made.

    Raises
    ------
    CommandError
        The duration is too short, the vehicle cannot be used, the folder exists, a node ended on its own, or the bag
        cannot be read or lacks something that the simulator counted.
    KeyboardInterrupt
        After the nodes have ended in order and what there is has been summarised.
    """
    console, path = Terminal(), find_vehicle(choices.vehicle).absolute()
    try:
        vehicle, _ = read_vehicle(path)
        tread = 2.0 * vehicle.road_wheels.y
        settling = _settling(choices, find_road(choices.road, tread).begins)
    except (RoadError, DriveFileError, VehicleFileError) as error:
        raise CommandError(str(error)) from None
    if choices.duration < settling + SHORTEST_MEASURING:
        how = f"at {choices.speed:g} m/s" if choices.drive is None else f"with drive {choices.drive}"
        raise CommandError(
            f"--duration is {choices.duration:g} s, must be at least {settling + SHORTEST_MEASURING:.1f} s {how}: "
            f"{settling:.1f} s to settle and {SHORTEST_MEASURING:g} s to measure"
        )
    with LoopProcesses(ONE_PROCESS if choices.one_process else FOUR_PROCESSES) as processes, viewing(vehicle):
        with own_domain():
            name = f"{datetime.now():%Y%m%dT%H%M%S}_{_short(choices.road)}_{_pace(choices)}"
            folder = make_folder(out or Path("runs") / name)
            with writing_to(folder):
                (folder / "log").mkdir()
            console.print(f"closed loop: {choices.title}")
            if choices.physics_rate < (least := recommended_rate(vehicle)):
                console.print(f"warning: --physics-rate {choices.physics_rate} is below the recommended {least} Hz")
            interrupt = _run_nodes(processes, choices, path, tread, folder, console)
        _measure(choices, settling, folder, console, interrupt)


def _measure(choices, settling, folder, console, interrupt):
    """Leave and print what the bag tells; raises as `run_loop`."""
    from .run_summary import evaluate  # loaded by `_follow`

    try:
        lacking = evaluate(choices, settling, folder, console)
    except (BagError, ValueError) as error:
        raise interrupt or CommandError(str(error)) from None
    if lacking:
        raise CommandError(f"the bag in {str(folder)!r} is not complete, it lacks {', '.join(lacking)}") from interrupt
    if interrupt is not None:
        raise interrupt


def _settling(choices, begins):
    """How long a run settles [s]: until all of the vehicle is on the road proper, which begins at a distance [m].

    A vehicle that never gets there, for it stands, settles as shortly as any."""
    if choices.drive is None:
        return settling_time(choices.speed, begins)
    arrival = arrival_time(parse_drive(drive_text(choices.drive), 0.0, choices.drive), begins + VEHICLE_BEHIND)
    return max(arrival, SHORTEST_SETTLING) if isfinite(arrival) else SHORTEST_SETTLING


@contextmanager
def own_domain():
    """Hold the ROS domain against further runs; raise `CommandError` if it is impossible or taken."""
    from ..nodes.watch import Watch  # imported late: ROS 2 comes after the processes have been made

    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not (domain.isdecimal() and int(domain) <= HIGHEST_DOMAIN):
        raise CommandError(f"ROS_DOMAIN_ID is {domain!r}, accepted is a whole number from 0 to {HIGHEST_DOMAIN}")
    taken = CommandError(f"a simulator runs in ROS domain {domain} already; set another ROS_DOMAIN_ID")
    # a name that the kernel frees with the process, however that ends
    with socket.socket(socket.AF_UNIX) as claim:
        try:
            claim.bind(f"\0trackvib_run_in_domain_{int(domain)}")
        except OSError:
            raise taken from None
        # a simulator that was started by hand is seen if it makes itself known in time
        with Watch() as watch:
            if watch.simulator_is_there():
                raise taken
        yield


def _run_nodes(processes, choices, vehicle, tread, folder, console):
    """Run the nodes to the end; returns the KeyboardInterrupt that cut them short, or None.

    `vehicle` is the path of its file, `tread` the distance between its tracks [m].
    """
    overrides = {
        "road_excitation": {"road": whole_name(choices.road), "seed": choices.seed, "track_distance": tread},
        "controller": {"law": choices.law},
        "recorder": {"bag": str(folder / "bag")},
        "simulator": {
            "vehicle_file": str(vehicle),
            "physics_rate": choices.physics_rate,
            "speed": float(choices.speed),
            "drive": "" if choices.drive is None else str(Path(choices.drive).absolute()),
            "gears": choices.gears,
            "duration": float(choices.duration),
            "view_rate": VIEW_RATE if choices.view else 0,
            "measure_rate": choices.measure_rate,
        },
    }
    interrupted = None
    try:
        processes.start(closed_loop_parameters(), overrides, folder / "log")
        _follow(processes, choices.duration, console)
    except KeyboardInterrupt as interrupt:
        interrupted = interrupt
    first = processes.ended()
    codes = processes.stop()
    if interrupted is None and any(codes.values()):
        name = next(name for name in (*first, *codes) if codes[name])
        said = processes.last_words(name)
        raise CommandError(_ending(name, codes[name], folder) + (f"; it said:\n{said}" if said else ""))
    return interrupted


def _ending(name, code, folder):
    """Return in words how a process ended."""
    if code > 0:
        return f"'{name}' ended with exit code {code}"
    words = f"'{name}' was ended by {signal.Signals(-code).name}"
    if name == "recorder":
        words += f"; `trackvib bag repair {folder / 'bag'}` completes what it had recorded"
    return words


def _follow(processes, duration, console):
    """Show progress until a process has ended."""
    from ..nodes.watch import Watch  # imported late, as above

    columns = (
        Description(),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:g} s, {task.fields[pace]} x real time"),
        TimeRemainingColumn(),
    )
    with Watch() as watch, Progress(*columns, console=console) as progress:
        task = progress.add_task("starting", total=duration, pace="-")
        from . import run_summary  # noqa: F401  what measures the run is loaded while its nodes start

        while not processes.ended():
            values = watch.look(_LOOK)
            if values:
                progress.update(
                    task,
                    description=values["state"],
                    completed=float(values["time"]),
                    pace=f"{float(values['real_time_factor']):.2f}",
                )


def _short(path):
    """Road or drive as a part of a file's name."""
    return re.sub(r"[^A-Za-z0-9-]+", "-", Path(path).stem)[:40] or "file"


def _pace(choices):
    return f"{choices.speed:g}" if choices.drive is None else _short(choices.drive)
