"""What the simulator tells about itself: its diagnostics while it runs, its last line at the end."""

from ..numerics.units import NANO
from ..vehicle.mount_energy import mount_energy_account

DRIVE = ("drive_work_J", "way_m")


def health(control, simulation, lockstep, phases, silent, controllers):
    """Return the level of the diagnostics ("ok", "warning", "error") and their values by name.

    Takes the node's `RunControl`, `Simulation`, `Lockstep` and `PhaseClock`, whether the controller is silent, and how
    many nodes answer.
    """
    level = "warning" if silent or lockstep.counts["saturated"] or controllers > 1 else "ok"
    return "error" if control.state == "failed" else level, {
        "state": control.state,
        "epoch": control.epoch,
        "controllers": controllers,
        "real_time_factor": round(phases.factor(simulation.time / NANO), 3),
        **progress(simulation, lockstep),
        **{f"{phase}_us_per_period": cost for phase, cost in phases.costs().items()},
    }


def progress(simulation, lockstep):
    """Return what a run itself tells by name, whoever runs it: time, currents in force, counts, work of the drive and
    on the mounts."""
    coils = zip(simulation.mounting.names, lockstep.currents.tolist(), strict=False)  # of the first mounts
    return {
        "time": simulation.time / NANO,
        **{f"current_{name}": current for name, current in coils},
        **lockstep.counts,
        **dict(zip(DRIVE, simulation.state.drive.driving.done.tolist(), strict=True)),
        **{
            f"mount_{part}_J": energy
            for part, energy in mount_energy_account(simulation.state.mount_energy)._asdict().items()
        },
    }


def summary(simulation, lockstep, phases):
    """Return in words how a run went: its pace, where the time of a period went, what was counted."""
    simulated = simulation.time / NANO
    costs = ", ".join(f"{phase} {cost:.0f} us" for phase, cost in phases.costs().items())
    counts = ", ".join(f"{count} {name}" for name, count in lockstep.counts.items() if count)
    pace = f"{simulated:g} s simulated at {phases.factor(simulated):.2f} x real time; a period: {costs}"
    return f"{pace}; answers: {counts}"
