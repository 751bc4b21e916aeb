"""A vehicle whose drive stands in front, and its mirror image driven backwards."""

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.vehicle.vehicle_file import read_vehicle

SETTLED, MEASURED = 1000, 4000  # ms


@pytest.fixture(scope="module")
def twin():
    """The M113 with left and right alike, so that no phase between the tracks depends on where they are laid from.

    Its pins are damped, and a spring holds its shoes on the ground, so that it rolls periodically.
    """
    vehicle = read_vehicle(find_vehicle("m113"))[0]
    arms = vehicle.swing_arms.model_copy(update={"right_wheel_x": None})
    tracks = vehicle.tracks.model_copy(update={"links": [63.0, 63.0], "pretension": [13e3, 13e3], "pin_damping": 1.0})
    ground = vehicle.ground.model_copy(update={"shear_stiffness": 1e6, "shear_damping": 3e3})
    return vehicle.model_copy(update={"swing_arms": arms, "tracks": tracks, "ground": ground})


def mirrored(vehicle):
    """Return the image of a vehicle whose front is the other's rear; no angles but those of trailing arms."""

    def image(section, *lengths, **items):
        flipped = {name: [-getattr(section, name)[0], *getattr(section, name)[1:]] for name in lengths}
        return section.model_copy(update=flipped | items)

    def solid(section, *lengths):
        xy, xz, yz = section.products
        return image(section, "centre", *lengths, products=[-xy, -xz, yz])

    v, arms = vehicle, vehicle.swing_arms
    direction = ["leading" if word == "trailing" else "trailing" for word in arms.direction]
    return vehicle.model_copy(
        update={
            "hull": solid(v.hull),
            "powertrain": solid(v.powertrain, "place"),
            "sensors": {name: image(sensor, "place") for name, sensor in v.sensors.items()},
            "swing_arms": arms.model_copy(update={"direction": direction, "wheel_x": [-x for x in arms.wheel_x[::-1]]}),
            "shock_absorbers": v.shock_absorbers.model_copy(update={"damping": v.shock_absorbers.damping[::-1]}),
            "sprockets": v.sprockets.model_copy(update={"x": -v.sprockets.x}),
            "idlers": v.idlers.model_copy(update={"x": -v.idlers.x}),
            "sprocket_teeth": v.sprocket_teeth.model_copy(update={"contacts": [-x for x in v.sprocket_teeth.contacts]}),
        }
    )


@pytest.mark.slow(reason="two whole drives")
@pytest.mark.property
def test_mirror_image_driven_backwards_gives_the_same_levels(simulation, level, twin):
    """Vertical and longitudinal levels of the hull on level ground, at 10 m/s and, mirrored, at -10 m/s."""
    found = []
    for vehicle, speed in ((twin, 10.0), (mirrored(twin), -10.0)):
        run = run_open_loop(simulation(speed, physics=20_000, vehicle=vehicle), level, SETTLED + MEASURED)
        assert run.speed[SETTLED:].mean() == pytest.approx(speed, rel=1e-2)
        force = run.specific_force[SETTLED:, 0]
        found.append((force - force.mean(axis=0)).std(axis=0)[[0, 2]])
    # rolling is periodic: the same but for where on the ring the tracks were laid from, which rounding makes part
    assert found[1] == pytest.approx(found[0], rel=0.05)
    assert np.min(found) > 0.1
