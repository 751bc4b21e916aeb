"""A step of the learning environment beside a bare control period of the same vehicle, in turns.

./trackvib exec -- python bench/learning.py
"""

import gymnasium
import trackvib_sim as tv
import trackvib_sim.learning  # noqa: F401  registers the environment
from machine import best_times, machine
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.vehicle.step_size import recommended_rate

STEPS, ROUNDS = 10, 600  # short turns: on a busy machine some are not disturbed
SEED = 1


def bare():
    """Return the function that does `STEPS` control periods under constant current, and no more."""
    vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    rates = tv.Rates(recommended_rate(vehicle))
    settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), rates, passive_current=1.0)
    simulation, feeder = tv.Simulation(vehicle, settings), RoadFeeder(tv.Iso8608Road("E", SEED), 50.0)

    def drive():
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        for _ in range(STEPS):
            simulation.advance(1.0)

    return drive


def stepping():
    """Return the function that does `STEPS` steps of the environment under a constant action."""
    env = gymnasium.make("trackvib/Mounts-v0")
    env.reset(options={"road_seed": SEED})
    action = env.unwrapped.action_of(1.0)

    def drive():
        for _ in range(STEPS):
            env.step(action)

    return drive


def main():
    """Time both, print."""
    times = best_times({"period": bare(), "step": stepping()}, ROUNDS)
    period, step = (1e6 * times[name] / STEPS for name in ("period", "step"))
    print(f"one core of {machine()}")
    print(f"control period {period:.1f} us, step of the environment {step:.1f} us: {step / period:.2f} times as much")


if __name__ == "__main__":
    main()
