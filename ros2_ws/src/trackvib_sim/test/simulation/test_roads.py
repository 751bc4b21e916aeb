"""What a step of the road does to the wheels on it."""

import numpy as np
import pytest
from trackvib_sim.road.obstacles import LevelRoad, ObstacleRoad, Step
from trackvib_sim.rui.sweeps.kinematics import MotionOffset, motion_vector, new_motion, update_motion
from trackvib_sim.vehicle.tracks.wheels import LOWER_RUN

HEIGHT, AT, SPEED = 0.1, 7.0, 3.0  # m, m, m/s
BEFORE, BEHIND = (1.0, 3.0), (12.0, 16.0)  # m, where no wheel and where every one is on it


@pytest.fixture
def hubs(simulation, drive):
    """A function that drives over a road and gives the mean heights of road wheels' hubs (2, k) [m] in both parts."""

    def measure(road):
        rolling, found = simulation(speed=SPEED), {BEFORE: [], BEHIND: []}
        tree, wheels = rolling.system.tree, rolling.system.tracks.wheels
        motion, rows = new_motion(tree), wheels.row[wheels.run == LOWER_RUN].reshape(2, -1)
        for each in drive(rolling, road, round(BEHIND[1] / SPEED * 1000)):
            for (begin, end), heights in found.items():
                if begin < each.distance < end:
                    update_motion(tree, each.state.tree, motion)
                    heights.append([motion_vector(motion, MotionOffset.ORIGIN, row)[2] for row in rows.flat])
        return [np.mean(found[part], axis=0).reshape(rows.shape) for part in (BEFORE, BEHIND)]

    return measure


@pytest.mark.slow(reason="drives a vehicle over each step")
@pytest.mark.analytic
@pytest.mark.parametrize(("side", "rises"), [("both", (HEIGHT, HEIGHT)), ("left", (HEIGHT, 0.0))])
def test_a_step_moves_wheels_by_its_height(hubs, side, rises):
    """Each wheel by the height, to 1 mm, on the side that has it; where only one has, tyres give as load moves."""
    road = ObstacleRoad(LevelRoad(0.05), (Step(shape="step", at=AT, height=HEIGHT, length=40.0, side=side),))
    before, behind = hubs(road)
    assert np.abs(behind - before - np.reshape(rises, (2, 1))).max() < (1e-3 if side == "both" else 2e-3)
