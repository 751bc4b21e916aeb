"""Compile every kernel once, so that no run pays for it: `python -m trackvib_sim.compile_kernels`."""

from mr_mount_controller.laws.passive import Passive

from .data import find_vehicle
from .numerics.units import NANO
from .road.iso8608 import FADE, LEVEL_UNTIL, Iso8608Road
from .simulation.closed_loop import run_closed_loop
from .simulation.open_loop import run_open_loop
from .simulation.running_gear import RunningGear
from .simulation.settings import Rates, RunSettings
from .simulation.simulation import Simulation
from .vehicle.system import Operation
from .vehicle.vehicle_file import read_vehicle


def main():
    """Run both loops in one process for two periods, and look at the running gear."""
    vehicle, _ = read_vehicle(find_vehicle())
    settings = RunSettings(Operation(10.0, 1650.0, False), Rates(), 1.0)
    simulation = Simulation(vehicle, settings)
    road = Iso8608Road("E", 1, LEVEL_UNTIL, FADE)
    run_closed_loop(simulation, road, Passive(settings.rates.period / NANO), 2)
    RunningGear(vehicle, simulation).read()
    run_open_loop(simulation, road, 2)


if __name__ == "__main__":
    main()
