"""Learns a law for the mounts by CMA-ES in the environment `trackvib/Mounts-v0`, and tries it on roads held back.

./trackvib exec -- python docs/examples/train_mounts.py
"""

import argparse
from time import perf_counter

import cma
import gymnasium
import numpy as np
import trackvib_sim.learning  # noqa: F401  registers the environment

ROAD, SPEED = "E", 10.0  # m/s
SETTLING = 2.0  # s of each drive that do not count
PASSIVE = 1.0  # A
TRAINING, HELD_BACK = 100, 900  # seeds of the first road of each kind
# of the powertrain's vertical motion on such a road, the last one across the mounts
ACCELERATION_SIZE, VELOCITY_SIZE, ACROSS_SIZE = 4.0, 0.1, 0.025  # m/s^2, m/s, m/s
CONSTANT = (1.0, 1.5, 2.0, 3.0, 4.0)  # A
ACCELERATION, VELOCITY, _, HULL_VELOCITY = range(12, 16)  # in the observation
WEIGHTS = 4


def constant(env, current=PASSIVE):
    """Return the policy that always demands one current [A]."""
    action = env.unwrapped.action_of(current)
    return lambda observation: action


def policy(env, weights):
    """Return the policy of some weights (4,).

    Firmness, -1 to 1, follows from what laws look at: whether the velocity across the mounts points the way of the
    powertrain's acceleration, and of its velocity, and how fast it is. All mounts get the same.
    """
    coils = env.action_space.shape

    def act(observation):
        across = (observation[VELOCITY] - observation[HULL_VELOCITY]) / ACROSS_SIZE
        acceleration, velocity = observation[ACCELERATION] / ACCELERATION_SIZE, observation[VELOCITY] / VELOCITY_SIZE
        features = 1.0, across * acceleration, across * velocity, abs(across)
        return np.full(coils, np.tanh(np.dot(weights, features)), np.float32)

    return act


def drive(env, act, road_seed, duration):
    """Return the RMS value of the powertrain's vertical acceleration under Wk [m/s^2] on one road."""
    observation, info = env.reset(options={"road_seed": road_seed})
    total = count = 0
    while info["time"] < duration:
        observation, reward, terminated, truncated, info = env.step(act(observation))
        if info["time"] > SETTLING:
            total, count = total - reward, count + 1
        if terminated or truncated:
            break
    return float(np.sqrt(total / count))


def levels(env, act, roads, duration):
    """Return logarithms of the levels of `drive` on some roads."""
    return np.log([drive(env, act, road, duration) for road in roads])


def train(env, roads, generations, duration):
    """Return the weights with the smallest mean of levels beside passive mounts, and the best constant current [A]."""
    beside = levels(env, constant(env), roads, duration)
    firmest = min(CONSTANT, key=lambda current: levels(env, constant(env, current), roads, duration).mean())

    def cost(weights):
        return float((levels(env, policy(env, weights), roads, duration) - beside).mean())

    search = cma.CMAEvolutionStrategy(WEIGHTS * [0.0], 0.5, {"seed": 1, "verbose": -9, "popsize": 8})
    for generation in range(1, generations + 1):
        candidates = search.ask()
        search.tell(candidates, [cost(candidate) for candidate in candidates])
        best = 100.0 * (np.exp(search.result.fbest) - 1.0)
        print(f"generation {generation} of {generations}: best {best:+.1f} % of passive", flush=True)
    return search.result.xbest, firmest


def told(what, changes):
    """Return in words how levels changed (n,), logarithms of their ratios."""
    per_cent = 100.0 * (np.exp(changes) - 1.0)
    mean, error = per_cent.mean(), per_cent.std(ddof=1) / np.sqrt(len(per_cent))
    verdict = "lower" if mean < -2.0 * error else "not lower"
    return f"{what}: {verdict}, {mean:+.1f} % with a standard error of {error:.1f} %"


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--generations", type=int, default=6)
    options.add_argument("--roads", type=int, default=3, help="to train on")
    options.add_argument("--held-back", type=int, default=8, help="roads to try it on")
    options.add_argument("--duration", type=float, default=5.0, help="of a drive, s")
    chosen = options.parse_args()
    began = perf_counter()
    env = gymnasium.make("trackvib/Mounts-v0", road=ROAD, speed=SPEED)
    roads = range(TRAINING, TRAINING + chosen.roads)
    weights, current = train(env, roads, chosen.generations, chosen.duration)
    print("weights:", ", ".join(f"{weight:.2f}" for weight in weights), flush=True)
    roads = range(HELD_BACK, HELD_BACK + chosen.held_back)
    before = levels(env, constant(env), roads, chosen.duration)
    print(f"weighted acceleration (Wk) of the powertrain on {len(roads)} roads held back, beside passive mounts:")
    for what, act in ((f"best constant current, {current:g} A", constant(env, current)),
                      ("learnt law", policy(env, weights))):  # fmt: skip
        print(told(what, levels(env, act, roads, chosen.duration) - before), flush=True)
    print(f"took {perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
