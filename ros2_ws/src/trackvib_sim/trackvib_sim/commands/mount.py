"""`trackvib mount`: a mount of a vehicle on a test bench, and a mount's parameters from measured loops."""

from itertools import product

import numpy as np
from mr_mount_controller.node_base.plain_text import plain_line, span
from mr_mount_controller.node_base.suggestion import suggestion
from rich.table import Table

from ..console import Terminal
from ..data import find_vehicle
from ..mount_bench.fit import fit_loops
from ..mount_bench.harmonic import loop_numbers, shake
from ..mount_bench.measured import read_loops
from ..mount_bench.mount_type import mount_type
from ..mount_bench.pictures import fit_picture, loops_picture
from ..vehicle.coil import usable_current
from ..vehicle.mounts import KILO, KN_PER_MM, mounts_in_order
from ..vehicle.system import Operation, build_system
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import all_or_nothing

MILLI = 1e-3
CURRENTS = (0.0, 1.0, 2.0, 4.0)  # A, by default


def run_bench(name_or_file, mount, amplitudes, frequencies, currents, out):
    """Shake a mount at all amplitudes [mm], frequencies [Hz] and currents [A]; leaves picture and loops in a folder.

    `currents` may be None, for those of `CURRENTS`, or none where the mount is of rubber.

    Raises
    ------
    ValueError
        The vehicle cannot be used, it has no such mount, or a current is beyond its mounts'.
    CommandError
        The folder is there already or cannot be written.
    """
    vehicle, _ = read_vehicle(find_vehicle(name_or_file))
    names = [name for name, _ in mounts_in_order(vehicle)]
    if not names:
        raise ValueError(f"vehicle {vehicle.name} has no mounts")
    mount = names[0] if mount is None else mount
    if mount not in names:
        raise ValueError(f"--mount {plain_line(mount)!r} is not one of {', '.join(names)}{suggestion(mount, names)}")
    mounts, index = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4).mounts, names.index(mount)
    if index < mounts.coils:
        low, high = usable_current(vehicle)
        currents = CURRENTS if currents is None else currents
        for current in currents:
            if not low <= current <= high:
                raise ValueError(f"--currents has {current:g} A, accepted: {span(low, high, 'A')}")
    else:
        if currents is not None:
            raise ValueError(f"mount {mount} is a rubber mount without a coil, omit --currents")
        currents = (0.0,)
    cases = product(currents, frequencies, amplitudes)
    loops = [shake(mounts, index, current, MILLI * amplitude, frequency) for current, frequency, amplitude in cases]
    with all_or_nothing(out) as folder:
        _write_loops(loops, folder / "loops.csv")
        loops_picture(loops, f"{vehicle.name}, mount {mount}: force along its own z axis", folder / "loops.png")
    console = Terminal()
    console.print(_loops_table(loops, f"mount {mount} of {vehicle.name}"))
    console.print(f"written to {out}: loops.csv, loops.png", soft_wrap=True)


def run_fit(file, law, carried_mass, out):
    """Fit a law to the measured loops of a file; leaves picture and items of a vehicle file in a folder.

    Raises
    ------
    measured.LoopsFileError, ValueError
        The loops cannot be used.
    CommandError
        The folder is there already or cannot be written.
    """
    loops = read_loops(file)
    fit = fit_loops(loops, law)
    items = mount_type(fit, carried_mass)
    with all_or_nothing(out) as folder:
        fit_picture(loops, fit.force, f"{law}: {fit.residual:.1%} of the force remains unexplained", folder / "fit.png")
        (folder / "mount_type.yaml").write_text("\n".join(items) + "\n", encoding="utf-8")
    console = Terminal()
    console.print(_fit_table(fit))
    console.print(
        f"constant force {fit.offset.value:.1f} ± {fit.offset.half:.1f} N; residual {fit.residual:.2%} of RMS"
    )
    for line in items:
        console.print(line, soft_wrap=True)
    console.print(f"written to {out}: fit.png, mount_type.yaml", soft_wrap=True)


def _write_loops(loops, path):
    with path.open("w", encoding="utf-8") as file:
        file.write("time_s,displacement_m,velocity_mps,force_N,current_A,frequency_Hz,amplitude_m\n")
        for loop in loops:
            time = np.arange(len(loop.force)) / (len(loop.force) * loop.frequency)
            for values in zip(time, loop.displacement, loop.velocity, loop.force, strict=True):
                same = (loop.current, loop.frequency, loop.amplitude)
                file.write(",".join(f"{value:.9g}" for value in (*values, *same)) + "\n")


def _loops_table(loops, title):
    table = Table(title=title, title_justify="left")
    for head in ("A", "Hz", "mm", "stiffness kN/mm", "loss kN/mm", "damping kN s/m", "heat J per cycle", "largest kN"):
        table.add_column(head, justify="right")
    for loop in loops:
        n = loop_numbers(loop)
        table.add_row(
            f"{loop.current:g}", f"{loop.frequency:g}", f"{loop.amplitude / MILLI:g}", f"{n.stiffness / KN_PER_MM:.3f}",
            f"{n.loss_stiffness / KN_PER_MM:.3f}", f"{n.damping / KILO:.2f}", f"{n.heat:.4g}",
            f"{n.largest_force / KILO:.3f}",
        )  # fmt: skip
    return table


def _fit_table(fit):
    table = Table(title=f"{fit.law}, with 95 % intervals if residuals are independent", title_justify="left")
    for head in ("A", "stiffness kN/mm", "damping kN s/m", "yield force kN"):
        table.add_column(head, justify="right")
    columns = (fit.stiffness, KN_PER_MM), (fit.damping, KILO), (fit.yield_force, KILO)
    for current in sorted(fit.stiffness | fit.damping):
        table.add_row(f"{current:g}", *(_with_interval(values.get(current), unit) for values, unit in columns))
    return table


def _with_interval(value, unit):
    return "" if value is None else f"{value.value / unit:.4g} ± {value.half / unit:.2g}"
