"""The environment of Gymnasium: its interface, that it is the loop, its reward, and what it refuses."""

import warnings

import gymnasium
import numpy as np
import pytest
import trackvib_sim.learning  # noqa: F401  registers it
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from mr_mount_controller.laws import find_law
from trackvib_sim.analysis.iso2631 import weighted
from trackvib_sim.data import find_vehicle
from trackvib_sim.learning.mounts_env import FAILED, MountsEnv
from trackvib_sim.learning.running_weighting import RunningWeighting
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

SEED, PERIODS = 7, 400


@pytest.fixture(scope="module")
def env():
    """The environment as users make it, shared: each test resets it."""
    return gymnasium.make("trackvib/Mounts-v0", speed=12.0)


@pytest.mark.cross_engine
def test_gymnasium_has_nothing_to_complain_about(env):
    """Its own checker neither raises nor warns."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)


@pytest.mark.property
def test_it_is_the_loop_to_the_bit(env):
    """Under the currents of a law, sensors and coils are those of the loop in one process."""
    vehicle, _ = read_vehicle(find_vehicle())
    rates = Rates(recommended_rate(vehicle))
    simulation = Simulation(vehicle, RunSettings(Operation(12.0, 1650.0, False, 0.25), rates, 1.0))
    law = find_law("skyhook")(1e-3, soft_current=1.0, firm_current=3.0)  # which single precision holds
    record = run_closed_loop(simulation, Iso8608Road("E", SEED), law, PERIODS)
    assert set(np.unique(record.current)) == {1.0, 3.0}
    observation, info = env.reset(options={"road_seed": SEED})
    for k in range(PERIODS):
        force, rate = record.specific_force[k], record.angular_velocity[k]
        expected = np.concatenate((force[0], rate[0], force[1], rate[1])).astype(np.float32)
        np.testing.assert_array_equal(observation[:12], expected)
        np.testing.assert_array_equal(info["current"], record.coil_current[k])
        action = np.array([env.unwrapped.action_of(current)[0] for current in record.current[k]])
        observation, _, terminated, truncated, info = env.step(action)
        assert not (terminated or truncated)
        np.testing.assert_array_equal(observation[16:], action)


@pytest.mark.property
def test_seeds_give_roads(env):
    """The same seed the same episode, the next episode another road, and a road by its own seed."""
    first, told = env.reset(seed=3)
    again, _ = env.reset(seed=3)
    _, other = env.reset()
    np.testing.assert_array_equal(first, again)
    assert told["road_seed"] != other["road_seed"]
    assert env.reset(options={"road_seed": np.int64(SEED)})[1]["road_seed"] == SEED


@pytest.mark.cross_engine
@pytest.mark.parametrize("name", ["Wk", "Wd", "Wf"])
def test_the_running_weighting_is_that_of_the_standard(name):
    """Within 1 % of the one by spectra, for noise up to 20 Hz; a constant before the start leaves nothing."""
    rate, random = 1000.0, np.random.default_rng(1)
    time = np.arange(20_000) / rate
    tones = [np.sin(2.0 * np.pi * (f * time + random.random())) for f in (0.2, 0.7, 2.0, 5.0, 11.0, 20.0)]
    values = np.sum(tones, axis=0)
    running = RunningWeighting(name, rate)
    found = np.array([running.update(9.81 + value) for value in values])
    expected = weighted(9.81 + values, name, rate)
    assert abs(found - expected).max() < 0.01 * abs(expected).max()


@pytest.mark.property
def test_the_reward_is_less_the_square_of_the_weighted_acceleration(env):
    """Of the powertrain, sample by sample."""
    observation, info = env.reset(seed=1)
    vertical, rewards = [float(observation[8])], [-(info["weighted"] ** 2)]
    for _ in range(2500):
        observation, reward, *_ = env.step(env.action_space.low)
        vertical.append(float(observation[8]))
        rewards.append(reward)
    expected = weighted(np.array(vertical), "Wk", 1000.0)[500:]
    assert -np.mean(rewards[500:]) == pytest.approx(np.mean(expected**2), rel=0.02) and np.mean(expected**2) > 0.01


@pytest.mark.property
def test_a_run_that_fails_ends_the_episode(tmp_path):
    """Before a wall, with the reward that is less than all others; then a reset is needed, and enough."""
    road = tmp_path / "wall.csv"
    road.write_text("distance_m,height_m\n" + "".join(f"{0.1 * k:.1f},{min(max(k - 5, 0), 9)}\n" for k in range(50)))
    env = gymnasium.make("trackvib/Mounts-v0", road=str(road), speed=20.0)
    env.reset()
    terminated = False
    while not terminated:
        _, reward, terminated, truncated, info = env.step(env.action_space.high)
        assert not truncated
    assert reward == FAILED and "after t =" in info["failure"]
    with pytest.raises(ResetNeeded, match="reset"):
        env.unwrapped.step(env.action_space.high)
    env.reset()
    assert env.step(env.action_space.high)[1] > FAILED


@pytest.mark.property
@pytest.mark.parametrize(
    ("action", "said"),
    [
        (np.array([np.nan, 0.0]), "accepted: finite numbers"),
        (np.array([np.inf, 0.0]), "accepted: finite numbers"),
        (np.zeros(3), r"has shape \(3,\), accepted: \(2,\)"),
        (0.5, r"has shape \(\), accepted: \(2,\)"),
        (["firm", "soft"], "accepted: numbers"),
        (None, "accepted"),
    ],
)
def test_actions_that_are_none(env, action, said):
    """Refused with what is accepted; the run goes on."""
    env.reset(seed=1)
    with pytest.raises(ValueError, match=said):
        env.unwrapped.step(action)
    assert env.step(2.0 * env.action_space.high)[0][-1] == 1.0  # what is beyond is cut


@pytest.mark.property
@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"speed": 5.0}, "there is no option 'speed'; known is 'road_seed'"),
        ({"road_seed": -1}, "'road_seed' is -1, accepted: a whole number from 0 to"),
        ({"road_seed": 1.5}, "'road_seed' is 1.5"),
        ({"road_seed": "1"}, "'road_seed' is '1'"),
    ],
)
def test_options_that_are_none(env, options, said):
    """Refused with what is accepted."""
    with pytest.raises(ValueError, match=said):
        env.reset(options=options)


@pytest.mark.property
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"speed": 99.0}, "'speed' is 99.0, accepted: a number from -25 to 25 m/s"),
        ({"spede": 5.0}, "there is no parameter spede; known are speed, drive"),
        ({"duration": 5.0}, "there is no parameter duration"),
        ({"control_rate": 999}, "physics_rate 5000 Hz and control_rate 999 Hz conflict"),
        ({"vehicle": "nowhere.yaml"}, "nowhere.yaml"),
        ({"road": "Z"}, "Z"),
        ({"render_mode": "human"}, "render_mode is 'human'"),
    ],
)
def test_environments_that_cannot_be_made(arguments, said):
    """Refused with what is accepted."""
    with pytest.raises(ValueError, match=said):
        MountsEnv(**arguments)
