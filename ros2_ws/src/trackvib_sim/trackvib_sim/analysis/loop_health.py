"""What a recording says about the loop: its losses, and what the simulator counted."""

from ..vehicle.mount_energy import MountEnergy
from .stamps import losses

MOUNTS = tuple(f"mount_{part}_J" for part in MountEnergy._fields)  # in the simulator's diagnostics


def loop_health(recording):
    """Return the `losses`, and what the simulator reported last as text, but for the work on the mounts."""
    return losses(recording) | {key: text for key, text in recording.diagnostics.items() if key not in MOUNTS}


def mount_energy(recording):
    """Return where the work on the mounts went, as the simulator reported at its end: a `MountEnergy`, or None."""
    values = [recording.diagnostics.get(key) for key in MOUNTS]
    return None if None in values else MountEnergy(*map(float, values))
