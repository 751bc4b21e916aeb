"""`trackvib mount`: a mount of a vehicle on a test bench, and a mount's parameters from measured loops."""

from itertools import product

import numpy as np
from mr_mount_controller.node_base.plain_text import plain_line
from rich.table import Table

from ..console import Terminal
from ..data import find_vehicle
from ..mount_bench.fit import fit_loops
from ..mount_bench.harmonic import loop_numbers, shake
from ..mount_bench.measured import read_loops
from ..mount_bench.pictures import fit_picture, loops_picture
from ..vehicle.coil import usable_current
from ..vehicle.mounts import KILO, KN_PER_MM, mounts_in_order
from ..vehicle.system import Operation, build_system
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import all_or_nothing

MILLI = 1e-3
HIGHEST_POWER = 3  # of the fits over current, as a vehicle file has them


def run_bench(name_or_file, mount, amplitudes, frequencies, currents, out):
    """Shake a mount at all amplitudes [mm], frequencies [Hz] and currents [A]; leaves picture and loops in a folder.

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
        raise ValueError(f"--mount {plain_line(mount)!r} is none of {', '.join(names)}")
    mounts, index = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4).mounts, names.index(mount)
    if index < mounts.coils:
        low, high = usable_current(vehicle)
        for current in currents:
            if not low <= current <= high:
                raise ValueError(f"--currents has {current:g} A, accepted are {low:g} to {high:g} A")
    else:
        currents = (0.0,)  # rubber has none
    cases = product(currents, frequencies, amplitudes)
    loops = [shake(mounts, index, current, MILLI * amplitude, frequency) for current, frequency, amplitude in cases]
    with all_or_nothing(out) as folder:
        _write_loops(loops, folder / "loops.csv")
        loops_picture(loops, f"{vehicle.name}, mount {mount}: force along its own z axis", folder / "loops.png")
    console = Terminal()
    console.print(_loops_table(loops, f"mount {mount} of {vehicle.name}"))
    console.print(f"left in {out}: loops.csv, loops.png", soft_wrap=True)


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
    items = _items(fit, carried_mass)
    with all_or_nothing(out) as folder:
        fit_picture(loops, fit.force, f"{law}: {fit.residual:.1%} of the force is left over", folder / "fit.png")
        (folder / "mount_type.yaml").write_text("\n".join(items) + "\n", encoding="utf-8")
    console = Terminal()
    console.print(_fit_table(fit))
    console.print(
        f"constant force {fit.offset.value:.1f} ± {fit.offset.half:.1f} N; left over {fit.residual:.2%} of RMS"
    )
    for line in items:
        console.print(line, soft_wrap=True)
    console.print(f"left in {out}: fit.png, mount_type.yaml", soft_wrap=True)


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
    for head in ("A", "Hz", "mm", "stiffness kN/mm", "loss kN/mm", "damping kN s/m", "heat J a cycle", "largest kN"):
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


def _items(fit, carried_mass):
    """Give the lines of a `mount_types` entry; polynomials of the highest power that the currents determine."""
    stiffness = {current: each.value for current, each in fit.stiffness.items()}
    ratio = {
        current: each.value / (2.0 * np.sqrt(stiffness[current] * carried_mass))
        for current, each in fit.damping.items()
    }
    yield_force = {current: each.value / KILO for current, each in fit.yield_force.items()}
    in_file = {current: each / KN_PER_MM for current, each in stiffness.items()}
    note = f"{fit.law} fit of measured loops, {fit.residual:.1%} of the force left over"
    fits = [("stiffness_fit", in_file, "kN/mm, I in A"), ("damping_ratio_fit", ratio, "-, I in A")]
    if yield_force:
        fits.append(("yield_force_fit", yield_force, "kN, I in A"))
    lines = ["kind: mr"]
    for name, values, unit in fits:
        power = min(HIGHEST_POWER, len(values) - 1)
        found = np.polyfit(list(values), list(values.values()), power)
        numbers = [0.0] * (HIGHEST_POWER - power) + [float(f"{each:.5g}") for each in found]
        lines.append(f'{name}: {{value: {numbers}, unit: "{unit}", source: calibrated, note: "{note}"}}')
    used = list(fit.damping)
    lines.append(f"current_range: {{value: [{min(used):g}, {max(used):g}], unit: A, source: calibrated}}")
    lines.append(f"carried_mass: {{value: {carried_mass:g}, unit: kg, source: assumed}}")
    return lines
