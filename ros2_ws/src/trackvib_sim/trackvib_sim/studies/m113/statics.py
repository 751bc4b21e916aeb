"""Static wheel loads and ride frequencies: the reference's, by statics of a rigid hull on its bars, and ours.

The reference's numbers are those that Project Chrono publishes for the vehicle, places in its chassis frame, whose
origin is the sprockets' axis. Tension of a track does no work on the vehicle as a whole, but at the end stations its
bend takes load off the ground and puts it on the bar, so that bars carry more than the ground gives.
"""

from math import asin, atan2, cos, hypot, pi, radians, sin, sqrt

import numpy as np
from scipy.optimize import root

from ...simulation.open_loop import run_open_loop
from ...simulation.settings import RunSettings
from ...simulation.simulation import Simulation
from ...vehicle.body_tree import GRAVITY
from ...vehicle.system import Operation
from ..case import rates_for
from .reference import LEVEL, road_of

WHEEL_X = np.array([[-0.655, -1.322, -1.989, -2.656, -3.322], [-0.740, -1.407, -2.074, -2.740, -3.407]])  # m, assembled
SIDE_Y = (1.0795, -1.0795)  # m
PIVOT = (0.288, -0.081)  # m, ahead of the wheel as assembled, and height
ARM, ASSEMBLED = 0.3177, radians(24.95)  # m, rad below the horizontal
BAR, BAR_TORQUE = 2.5e4, 1e4  # N m/rad, N m as assembled
HULL_MASS, HULL_X, PITCH_INERTIA = 7819.24, -2.006, 27287.61  # kg, m, kg m^2
ARM_MASS, WHEEL_MASS, SPROCKET_MASS, IDLER_MASS, SHOE_MASS, SHOE = 75.26, 35.56, 27.68, 35.76, 18.02, 0.154
IDLER = (-3.95, -0.12)  # m
SPROCKET_RADIUS, IDLER_RADIUS, WHEEL_RADIUS = 0.24, 0.285, 0.335  # m of the pin line
ENDS = ((0, (0.0, 0.0), SPROCKET_MASS, SPROCKET_RADIUS), (4, IDLER, IDLER_MASS, IDLER_RADIUS))  # by nearest station
RIM, GROUND = (
    8 * 2.32e6,
    8 * 3.09e6,
)  # N/m^1.5 of contacts after Hertz: eight a wheel, four corners of each of two shoes
TENSION = (13.0e3, 2.05e3)  # N, half of what was measured at the tensioners
SETTLING = 2000  # periods in which our vehicle comes to rest


def reference_wheel_loads():
    """Return what the reference's wheels put on their arms, (2, 5) N, left and right from front to rear."""
    y = np.array(SIDE_Y)[:, None]
    pivot = WHEEL_X + PIVOT[0]

    def loads(unknowns):
        height, pitch, roll = unknowns[:3]
        given = unknowns[3:].reshape(WHEEL_X.shape)
        drop = height + PIVOT[1] - pitch * pivot + roll * y + given  # of the wheels below the pivots
        angle = np.arcsin(drop / ARM)
        reach = ARM * np.cos(angle)
        torque = BAR_TORQUE - BAR * (angle - ASSEMBLED)
        return torque / reach + (0.5 * ARM_MASS + WHEEL_MASS) * GRAVITY, pivot - reach, height + given

    def residual(unknowns):
        carried, x, axle = loads(unknowns)
        ground, weight = carried.copy(), [(HULL_MASS, HULL_X, 0.0)]
        for side, pull in enumerate(TENSION):
            for station, place, mass, radius in ENDS:
                run, rise = _end_run(x[side, station], -axle[side, station], place, radius)
                ground[side, station] -= pull * sin(rise)
                above = place[1] + radius + axle[side, station] - WHEEL_RADIUS
                weight.append((mass + _hanging(pull, above, radius, run), place[0], SIDE_Y[side]))
        own = [ARM_MASS * 0.5 * (x + pivot) + WHEEL_MASS * x, ARM_MASS * y + WHEEL_MASS * y + 0.0 * x]
        masses, at_x, at_y = np.array(weight).T
        total = (
            ground.sum() - GRAVITY * (masses.sum() + (ARM_MASS + WHEEL_MASS) * x.size),
            (ground * x).sum() - GRAVITY * ((masses * at_x).sum() + own[0].sum()),
            (ground * y).sum() - GRAVITY * ((masses * at_y).sum() + own[1].sum()),
        )
        gives = (carried / RIM) ** (2.0 / 3.0) + (np.maximum(ground, 0.0) / GROUND) ** (2.0 / 3.0)
        return np.concatenate((np.array(total) / 1e5, (unknowns[3:] - gives.ravel()) * 10.0))

    found = root(residual, np.concatenate(((0.3, 0.0, 0.0), np.full(WHEEL_X.size, 0.01))))
    if not found.success:
        raise ArithmeticError(f"the reference's wheels find no balance: {found.message}")
    return loads(found.x)[0]


def _end_run(x, z, place, radius):
    """Length [m] and slope [rad] of the run from a road wheel's lower side to an end wheel's."""
    dx, dz = abs(place[0] - x), place[1] - z
    distance = hypot(dx, dz)
    return distance, atan2(dz, dx) + asin((WHEEL_RADIUS - radius) / distance)


def _hanging(pull, height, radius, run):
    """Mass [kg] of the track at an end wheel of a radius [m]: what is wrapped round it and half of the run below.

    And the upper run, which hangs as a parabola, to where it comes down by the height [m] to the road wheels, at most
    half of it.
    """
    upper = min(sqrt(2.0 * pull * max(height, 0.0) / (SHOE_MASS / SHOE * GRAVITY)), 0.5 * abs(IDLER[0]))
    return SHOE_MASS / SHOE * (upper + pi * radius + 0.5 * run)


def reference_ride_frequencies():
    """Return heave and pitch [Hz] of the reference's hull on its bars, contacts rigid."""
    angle = radians(43.0)
    load = HULL_MASS * GRAVITY / WHEEL_X.size
    rate = (BAR - load * ARM * sin(angle)) / (ARM * cos(angle)) ** 2
    lever = WHEEL_X - HULL_X
    heave, pitch = rate * WHEEL_X.size / HULL_MASS, rate * (lever**2).sum() / PITCH_INERTIA
    return sqrt(heave) / (2.0 * pi), sqrt(pitch) / (2.0 * pi)


def standing_wheel_loads(vehicle):
    """Return what a standing vehicle's wheels put on their arms, (2, stations) N, as its run-in leaves it."""
    simulation = Simulation(vehicle, RunSettings(Operation(0.0, 0.0, False), rates_for(vehicle), 0.0))
    run_open_loop(simulation, road_of(LEVEL), SETTLING)
    bars, arms = simulation.system.suspension, vehicle.swing_arms
    jounce = simulation.state.tree.hinge[bars.row]
    reach = arms.length * np.cos(radians(arms.static_angle) - jounce)
    torque = bars.preload + bars.bar_stiffness * jounce
    half = hypot(arms.centre[0], arms.centre[2]) / arms.length
    carried = torque / reach + (half * arms.mass + vehicle.road_wheels.mass) * GRAVITY
    return carried.reshape(2, -1)
