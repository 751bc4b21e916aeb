"""The whole vehicle driven: speeds that are held, curves that are taken, gears, and where the energy goes."""

import numpy as np
import pytest
from trackvib_sim.numerics.units import RPM
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import RunFailed, Simulation
from trackvib_sim.vehicle.drive.path import SPACING
from trackvib_sim.vehicle.drive.schedule import Schedule
from trackvib_sim.vehicle.energy import Source, energy
from trackvib_sim.vehicle.energy_meter import EnergyMeter
from trackvib_sim.vehicle.system import Operation

pytestmark = pytest.mark.property


def scheduled(at, speed, curvature=None, by_distance=False):
    """A schedule with the engine at rated speed."""
    at = np.array(at, dtype=float)
    curvature = np.zeros(len(at)) if curvature is None else np.array(curvature, dtype=float)
    return Schedule(by_distance, at, np.array(speed, dtype=float), curvature, np.full(len(at), 1650.0 * RPM))


@pytest.fixture(scope="module")
def driven(vehicle):
    """A function that returns a simulation of a schedule, with gears or without."""

    def make(schedule, gears=False, rates=None):
        operation = Operation(0.0, 1650.0, False, 0.25, schedule, gears)
        return Simulation(vehicle, RunSettings(operation, rates or Rates(), 1.0))

    return make


def speed_of(simulation):
    """Forward speed of the hull [m/s]."""
    return float(simulation.sample.hull_velocity[0, 0])


@pytest.mark.slow(reason="drives for many seconds")
@pytest.mark.parametrize("gears", [False, True])
def test_a_schedule_is_kept(driven, drive, level, vehicle, gears):
    """Within 0.3 m/s once it settles, accelerating, steady, braking; the engine turns by the gear, to the last bit.

    Over the steady second at 11 m/s engine and vehicle speed have the ratio of gear and way of a tooth, to 1 %: the
    pull stretches tracks, and shoes creep.
    """
    moving = driven(scheduled([0.0, 2.0, 8.0, 11.0, 15.0], [5.0, 5.0, 11.0, 11.0, 3.0]), gears)
    d, gears_seen, steady, ratios = moving.state.drive, set(), [], moving.system.drive.driveline.ratio
    way = moving.system.tracks.sprockets.teeth * vehicle.tracks.pitch / (2.0 * np.pi)
    for each in drive(moving, level, 17_000):
        if each.periods > 1000:
            assert abs(speed_of(each) - d.wanted.speed[0]) < 0.3, each.time
        if gears:
            gear = int(d.shaft.gear[0])
            gears_seen.add(gear)
            ratio = ratios[gear - 1]
            assert d.crank.speed[0] == max(ratio * d.shaft.rate[0], 450.0 * RPM)
            if 9500 < each.periods <= 10_500:
                steady.append(d.crank.speed[0] * way / (ratio * speed_of(each)))
    if gears:
        assert np.mean(steady) == pytest.approx(1.0, abs=0.01)
    assert len(gears_seen) >= 3 if gears else d.crank.speed[0] == 1650.0 * RPM


@pytest.mark.slow(reason="drives for many seconds")
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_turn_of_20_m_radius(driven, drive, level, side):
    """At 5 m/s, to either side: the yaw rate becomes v / R, the outer sprocket turns faster, and the path is kept.

    The outer track's way over the inner one's is (R + b) / (R - b), b half the tread, less the slip of both.
    """
    moving = driven(scheduled([0.0, 10.0, 10.1], [5.0] * 3, [0.0, 0.0, side / 20.0], by_distance=True))
    yaw, rates, offset = [], [], []
    for each in drive(moving, level, 16_000):
        if each.periods > 10_000:
            yaw.append(each.sample.hull_angular_velocity[0, 2])
            rates.append(each.state.tree.hinge_rate[each.system.drive.driver.sprocket].copy())
            offset.append(each.state.drive.path.offset[0])
    assert np.mean(yaw) == pytest.approx(side * 5.0 / 20.0, rel=0.03)
    assert np.abs(offset).max() < 0.3
    left, right = np.mean(rates, axis=0)
    outer, inner = (right, left) if side > 0.0 else (left, right)
    tread = moving.system.drive.driver.half_tread
    assert outer / inner > (20.0 + tread) / (20.0 - tread)
    assert moving.distance == pytest.approx(16.0 * 5.0, rel=0.02)


@pytest.mark.slow(reason="drives for some seconds")
def test_a_road_lies_along_the_path(driven, drive, heights):
    """A step of 5 cm under both tracks behind a curve lifts the hull by it where the path says, not where x does."""
    step = heights(*[lambda x: np.where(x > 50.0, 0.05, 0.0)] * 2)
    moving = driven(scheduled([0.0, 10.0, 10.1], [5.0] * 3, [0.0, 0.0, 0.05], by_distance=True))
    height = {}
    for each in drive(moving, step, 12_000):
        height[each.distance] = each.state.tree.position[0, 2]
    before = np.mean([z for s, z in height.items() if 40.0 < s < 44.0])
    behind = np.mean([z for s, z in height.items() if 55.0 < s < 58.0])
    assert behind - before == pytest.approx(0.05, abs=0.004)
    assert moving.state.tree.position[0, 0] < 40.0


@pytest.mark.slow(reason="takes the account of many steps")
@pytest.mark.parametrize(
    ("schedule", "begin"),
    [
        (scheduled([0.0, 0.5, 4.5], [9.0, 9.0, 2.0]), 1000),
        (scheduled([0.0, 1.0, 1.1], [5.0] * 3, [0.0, 0.0, 0.05], by_distance=True), 3000),
    ],
    ids=["braking", "turning"],
)
def test_energy_is_accounted_for(driven, drive, level, schedule, begin):
    """While braking and turning: what drive and engine give less heat is what the vehicle holds, to 1 % of the heat."""
    rate = 10_000
    moving = driven(schedule, rates=Rates(rate, rate, rate))
    list(drive(moving, level, begin * 10))
    meter, given, heat, held = EnergyMeter(moving.system), 0.0, 0.0, []
    for _ in range(10_000):
        road = moving.road.around(moving.distance - 8.0, moving.distance + 8.0)
        meter.open(moving.state)
        moving.advance(np.ones(2))
        meter.close(moving.state, road)
        given += meter.account.given.sum() / rate
        heat += meter.account.dissipation.sum() / rate
        held.append(energy(meter.account))
    assert heat > 1e3 and abs(given - heat - (held[-1] - held[0])) < 0.01 * heat + 0.01 * abs(given)
    assert meter.account.given[Source.DRIVER] != 0.0


@pytest.mark.slow(reason="drives for many seconds")
def test_backwards_the_lane_is_kept_and_a_bend_taken_again(driven, drive, level):
    """After a bend a vehicle that is told to go back follows its path to the start and beyond, and then forwards."""
    moving = driven(scheduled([0.0], [5.0]))
    list(drive(moving, level, 500))
    for speed, yaw_rate, seconds in ((6.0, 0.2, 6), (-5.0, 0.0, 16), (4.0, 0.0, 6)):
        moving.command(speed, yaw_rate)
        offset = [each.state.drive.path.offset[0] for each in drive(moving, level, 1000 * seconds)]
        assert np.abs(offset).max() < 1.0 and abs(offset[-1]) < 0.5
        assert speed_of(moving) == pytest.approx(speed, abs=0.3)
    assert moving.distance < 0.0


def test_a_command_holds_from_the_next_period_on(driven, drive, level):
    """Speed and curvature replace the schedule's; the path bends ahead of the front, not under the hull."""
    moving = driven(scheduled([0.0], [5.0]))
    list(drive(moving, level, 200))
    moving.command(6.0, 0.3)
    list(drive(moving, level, 500))
    d = moving.state.drive
    assert d.wanted.speed[0] == pytest.approx(6.0) and d.path.curved[0]
    newest = int(d.path.newest[0])
    assert d.path.curvature[newest % len(d.path.curvature)] == pytest.approx(0.05 * min(1.0, newest * SPACING), rel=0.3)
    first = moving.state.tree.position[0].copy()
    assert first[1] == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize(
    ("speed", "yaw_rate", "words"),
    [
        (26.0, 0.0, "speed is 26.0 m/s, accepted: -25 to 25 m/s"),
        (np.nan, 0.0, "speed is nan"),
        (5.0, np.inf, "yaw rate is inf"),
        (0.0, 0.2, "turning on the spot is not modelled"),
        (1.0, 0.2, "curvature is 0.2 1/m"),
        (-5.0, 0.1, "curvature is -0.02 1/m at -5 m/s, accepted in reverse is 0"),
    ],
)
def test_a_command_that_cannot_be_driven_is_refused(driven, speed, yaw_rate, words):
    """With value and accepted range; nothing changes."""
    moving = driven(scheduled([0.0], [5.0]))
    with pytest.raises(ValueError) as refused:
        moving.command(speed, yaw_rate)
    assert words in str(refused.value) and not moving.state.drive.wanted.commanded[0]


def test_expected_commands_give_the_same_bits(driven, drive, level):
    """A run that is told its commands beforehand is the one that got them on the way."""
    one, other = driven(scheduled([0.0], [5.0])), driven(scheduled([0.0], [5.0]))
    other.expect([(100_000_000, 6.0, 0.0), (150_000_000, 6.5, 0.2)])
    for period, (ours, theirs) in enumerate(zip(drive(one, level, 400), drive(other, level, 400), strict=True), 1):
        assert ours.sample.specific_force.tobytes() == theirs.sample.specific_force.tobytes(), period
        if period == 100:
            ours.command(6.0, 0.0)
        if period == 150:
            ours.command(6.5, 0.2)


@pytest.mark.slow(reason="drives for some seconds")
def test_a_curve_that_is_too_fast_is_left(driven, drive, level):
    """At 15 m/s a radius of 12 m is beyond friction: the run ends with words, not with a place beside the road."""
    moving = driven(scheduled([0.0, 10.0, 10.1], [15.0] * 3, [0.0, 0.0, 1.0 / 12.0], by_distance=True))
    with pytest.raises(RunFailed, match="left its path|overturned|skipped a tooth|wheel lies below"):
        list(drive(moving, level, 6000))
