"""From a fit of measured loops to the items of a vehicle file."""

import numpy as np

from ..vehicle.mounts import KILO, KN_PER_MM

HIGHEST_POWER = 3  # of the fits over current, as a vehicle file has them


def mount_type(fit, carried_mass):
    """Return the lines of a `mount_types` entry from a `fit.Fit`, its damping ratio referred to a mass [kg].

    Polynomials over current have the highest power that the currents determine.
    """
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
