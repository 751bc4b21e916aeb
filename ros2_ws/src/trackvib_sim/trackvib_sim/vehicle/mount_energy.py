"""The energy account of the mounts along a run, kept in every physics step.

    work on a mount = dissipated + stored + exchanged

A mount takes work from hull, powertrain and the displacement that the engine imposes. Its damping turns work into heat,
its springs store it, and where the current changes while the field holds energy, a part goes to the magnetic field and
is lost (`mount_law`): never less than none.

As in `energy.py`, speeds belong to the middle of the steps and places to their ends. So the force of a step, as it
acted, does its work at the mean of the speeds before and after it, and its damping turns work into heat at the same;
the spring is looked at, and changes its stiffness, in the middle of the steps. What is then left over falls with the
step squared.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined
from ..numerics.spatial import add, dot, load3, scale, store3, subtract
from .mount_law import mount_axes, mount_force, mount_stored_energy, switch_field
from .mounts import mount_current, mount_deflection


class MountEnergyState(NamedTuple):
    """What went where since `start_mount_energy`, mount by mount (m), and what the next step needs of the last one."""

    work: np.ndarray  # (m,) done on the mount, J
    dissipated: np.ndarray  # (m,) J
    stored: np.ndarray  # (m,) J
    exchanged: np.ndarray  # (m,) lost to the magnetic field, J
    force: np.ndarray  # (m, 3) on the powertrain, N
    damping: np.ndarray  # (m, 3) its part against the motion, N
    speed: np.ndarray  # (m, 3) between the ends, without what is imposed, m/s
    imposed_rate: np.ndarray  # (m,) m/s
    energy: np.ndarray  # (m,) of the spring, J


class MountEnergy(NamedTuple):
    """The account of all mounts together [J], as in `MountEnergyState`."""

    work: float
    dissipated: float
    stored: float
    exchanged: float

    @property
    def residual(self):
        """What the account leaves over."""
        return self.work - self.dissipated - self.stored - self.exchanged

    @property
    def error(self):
        """The same as a share of the greatest part; 0 where nothing moves."""
        greatest = max(map(abs, self))
        return abs(self.residual) / greatest if greatest > 0.0 else 0.0


def new_mount_energy_state(m):
    """Return an account of m mounts without a step."""
    return MountEnergyState(*(np.zeros(shape) for shape in (m, m, m, m, (m, 3), (m, 3), (m, 3), m, m)))


def start_mount_energy(account):
    """Let the account begin at the step that was done last."""
    for part in (account.work, account.dissipated, account.stored, account.exchanged):
        part[:] = 0.0


def mount_energy_account(account):
    """Return the `MountEnergy` since `start_mount_energy`."""
    parts = (account.work, account.dissipated, account.stored, account.exchanged)
    return MountEnergy(*(float(part.sum()) for part in parts))


@inlined
def update_mount_energy(mounts, fields, motion, currents, imposed, imposed_rate, dt, account):
    """Let the fields follow their currents, book the last step [s] and note the mounts' forces for the next one."""
    for index in range(mounts.body.size):
        _, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        current, own_rate = mount_current(mounts, index, currents), mounts.excited[index] * imposed_rate
        speed = add(l_d, (0.0, 0.0, own_rate))
        mean = scale(0.5, add(load3(account.speed, index), speed))
        mean = subtract(mean, (0.0, 0.0, account.imposed_rate[index]))
        middle = subtract(l, scale(0.5 * dt, l_d))
        if index < mounts.coils:
            heat, lost = switch_field(mounts, fields, index, current, middle)
            account.dissipated[index] += heat
            account.exchanged[index] += lost
        energy = mount_stored_energy(mounts, fields, index, middle)
        account.work[index] -= dt * dot(load3(account.force, index), mean)
        account.dissipated[index] += dt * dot(load3(account.damping, index), mean)
        account.stored[index] += energy - account.energy[index]
        force, _ = mount_force(mounts, fields, index, current, l, l_d)
        _, c = mount_axes(mounts, index, current)
        store3(account.force, index, force)
        store3(account.damping, index, (c[0] * l_d[0], c[1] * l_d[1], c[2] * l_d[2]))
        store3(account.speed, index, speed)
        account.energy[index], account.imposed_rate[index] = energy, own_rate
