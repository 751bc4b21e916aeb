"""What the simulator tells about itself: its diagnostics while it runs, its last line at the end."""

from ..simulation.settings import NANO
from ..vehicle.mount_audit import mount_account


def health(control, simulation, exchange, phases, silent, controllers):
    """Return the level of the diagnostics ("ok", "warning", "error") and their values by name.

    Takes the node's `RunControl`, `Simulation`, `Exchange` and `PhaseClock`, whether the controller is silent, and how
    many nodes answer.
    """
    level = "warning" if silent or exchange.counts["saturated"] or controllers > 1 else "ok"
    simulated = simulation.time / NANO
    left, right = exchange.currents.tolist()
    return "error" if control.state == "failed" else level, {
        "state": control.state,
        "epoch": control.epoch,
        "time": simulated,
        "controllers": controllers,
        "current_left": left,
        "current_right": right,
        "real_time_factor": round(phases.factor(simulated), 3),
        **exchange.counts,
        **{f"mount_{part}_J": energy for part, energy in mount_account(simulation.state.audit)._asdict().items()},
        **{f"{phase}_us_per_period": cost for phase, cost in phases.costs().items()},
    }


def summary(simulation, exchange, phases):
    """Return in words how a run went: its pace, where the time of a period went, what was counted."""
    simulated = simulation.time / NANO
    costs = ", ".join(f"{phase} {cost:.0f} us" for phase, cost in phases.costs().items())
    counts = ", ".join(f"{count} {name}" for name, count in exchange.counts.items() if count)
    pace = f"{simulated:g} s simulated at {phases.factor(simulated):.2f} x real time; a period: {costs}"
    return f"{pace}; answers: {counts}"
