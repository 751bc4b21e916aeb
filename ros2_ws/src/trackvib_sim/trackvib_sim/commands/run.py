"""One run of the closed loop from the command line: processes, progress, and what the bag then tells."""

import re
import signal
from contextlib import nullcontext
from datetime import datetime
from pathlib import Path

from mr_mount_controller.node_base.endings import REFUSED
from mr_mount_controller.node_base.topics import CHASSIS_IMU
from rich.progress import TextColumn

from ..bags.contents import contents
from ..bags.errors import BagError
from ..console import Terminal, progress_on
from ..nodes.loop_arguments import RECORDER, SIMULATOR
from ..nodes.processes import FOUR_PROCESSES, ONE_PROCESS, LoopProcesses
from ..vehicle.plausibility import doubts
from ..vehicle.step_size import recommended_rate
from .own_domain import own_domain
from .result_folder import CommandError, Refused, all_or_nothing
from .run_choices import choose

_LOOK = 0.05  # s between looks at processes and progress


def run_loop(choosing, out, lookout, viewing=lambda _choices, _vehicle: nullcontext()):
    """Do a run; everything it leaves lies in one new folder, `out` or one named by time, road and speed.

    `choosing` are the arguments of `run_choices.choose` by name, `lookout` is the `Lookout` in their namespace that has
    been at work since. `viewing` makes a context manager for the time of the
    run from its `Choices` and vehicle (`parameters.Vehicle`), entered once its processes have been made.

    Raises
    ------
    CommandError
        The duration is too short, the vehicle cannot be used, the folder exists, a node ended on its own, or the bag
        cannot be read or lacks something that the simulator counted.
    KeyboardInterrupt
        After the nodes have ended in order and what there is has been summarised; its words say what is kept.

    A run that is refused or has no sample leaves no folder.
    """
    console = Terminal()
    choices, parameters, vehicle = choose(**choosing)
    doubted = _doubts(vehicle)  # before the nodes are forked, which then have what this loads: the first of the kernels
    executables = ONE_PROCESS if choices.one_process else FOUR_PROCESSES
    with LoopProcesses(executables) as processes, viewing(choices, vehicle), own_domain(lookout):
        name = f"{datetime.now():%Y%m%dT%H%M%S}_{_short(choices.road)}_{_pace(choices)}"
        with all_or_nothing(out or Path("runs") / name, _worth_keeping) as folder:
            (folder / "log").mkdir()
            parameters.give(RECORDER, bag=str(folder / "bag"))
            parameters.give(SIMULATOR, wait_for_view=choices.view)
            console.print(f"closed loop: {choices.title}")
            for note in parameters.notes:
                console.print(f"warning: {note}", soft_wrap=True)
            if choices.physics_rate < (least := recommended_rate(vehicle)):
                console.print(f"warning: --physics-rate {choices.physics_rate} is below the recommended {least} Hz")
            for doubt in doubted:
                console.print(f"warning: {doubt}", soft_wrap=True)
            interrupt = _run_nodes(processes, choices, parameters, folder, console)
            _measure(choices, folder, console, interrupt)


def _worth_keeping(folder, error):
    """Whether a run that ended in an error leaves its folder: it was not refused, and an interrupted one has samples.

    The words of an interrupt then say what is kept.
    """
    if not isinstance(error, KeyboardInterrupt):
        return not isinstance(error, Refused)
    try:
        bags = [contents(bag) for bag in folder.glob("bag*")]
        if not any(count for bag in bags for topic, count in bag.counts.items() if topic.endswith(CHASSIS_IMU)):
            return False
        what = "bags are complete up to here"
    except BagError as damage:  # the recorder was not waited for
        what = str(damage)
    error.args = (f"{_kept(folder)}; {what}",)
    return True


def _kept(folder):
    return f"kept in {folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}"


def _doubts(vehicle):
    """Return what is not plausible in a vehicle; of one that cannot stand why, which the simulator judges."""
    try:
        return doubts(vehicle)
    except ValueError as error:
        return [str(error)]


def _measure(choices, folder, console, interrupt):
    """Leave and print what the bag tells; raises as `run_loop`."""
    from .run_summary import evaluate  # loaded by `_follow`

    try:
        lacking = evaluate(choices, folder, console)
    except (BagError, ValueError) as error:
        raise interrupt or CommandError(str(error)) from None
    if lacking:
        raise CommandError(f"the bag in {str(folder)!r} is not complete: {', '.join(lacking)} missing") from interrupt
    if interrupt is not None:
        raise interrupt


def _run_nodes(processes, choices, parameters, folder, console):
    """Run the nodes to the end; returns the KeyboardInterrupt that cut them short, or None."""
    interrupted = None
    try:
        processes.start(parameters, folder / "log")
        _follow(processes, choices, console)
    except KeyboardInterrupt as interrupt:
        interrupted = interrupt
    first = processes.ended()
    codes = processes.stop()
    if interrupted is None and any(codes.values()):
        name = next(name for name in (*first, *codes) if codes[name])
        if codes[name] == REFUSED:
            raise Refused(f"'{name}' cannot run{processes.why(name)}")
        failure = CommandError(f"{_ending(name, codes[name], folder)}{processes.why(name)}")
        if folder.is_dir():  # nobody has taken it away meanwhile
            failure.add_note(_kept(folder))
        raise failure
    return interrupted


def _ending(name, code, folder):
    """Return in words how a process ended."""
    if code > 0:
        return f"'{name}' ended with exit code {code}"
    words = f"'{name}' was terminated by {signal.Signals(-code).name}"
    if name == "recorder":
        words += f"; `trackvib bag repair {folder / 'bag'}` completes what it had recorded"
    return words


def _follow(processes, choices, console):
    """Show progress until a process has ended."""
    from ..nodes.watch import Watch  # imported late, as above

    reached = TextColumn("{task.completed:.1f} of {task.total:g} s, {task.fields[pace]} x real time")
    with Watch(choices.namespace) as watch, progress_on(console, reached) as progress:
        task = progress.add_task("starting", total=choices.duration, pace="-")
        values, over = {}, False
        while not over:
            over = bool(processes.ended())  # what was said at last is still to be heard
            values = watch.look(0.0 if over and values else _LOOK)
            if values:
                from . import run_summary  # noqa: F401  what measures the run is loaded while it goes on

                progress.update(
                    task,
                    description=values["state"],
                    completed=float(values["time"]),
                    pace=f"{float(values['real_time_factor']):.2f}",
                )
        if not any(processes.ended().values()) and values.get("state") != "finished":
            progress.update(task, visible=False)  # the last news was not heard: an older one would tell a wrong end


def _short(path):
    """Road or drive as a part of a file's name."""
    return re.sub(r"[^A-Za-z0-9-]+", "-", Path(path).stem)[:40] or "file"


def _pace(choices):
    return f"{choices.speed:g}" if choices.drive is None else _short(choices.drive)
