"""What the simulator node makes of its parameters: one sentence where it cannot run."""

import pytest
import yaml
from mr_mount_controller.node_base.parameters import ParameterError
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.simulator_parameters import PARAMETERS, prepare

pytestmark = pytest.mark.property


@pytest.fixture
def refusal(tmp_path):
    """A function that returns with which message values are refused; `vehicle` changes items of the shipped file."""

    def refuse(vehicle=(), **values):
        content = yaml.safe_load(find_vehicle().read_text(encoding="utf-8"))
        for (*sections, item), value in dict(vehicle).items():
            items = content
            for section in sections:
                items = items[section]
            items[item]["value"] = value
        file = tmp_path / "my.yaml"
        file.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        defaults = {parameter.name: parameter.default for parameter in PARAMETERS}
        with pytest.raises(ParameterError) as refused:
            prepare({**defaults, "vehicle_file": str(file), **values})
        return str(refused.value)

    return refuse


def test_defaults_make_a_simulation(vehicle):
    """The defaults are those of the shipped vehicle at 10 m/s."""
    simulation, usable, text, drive = prepare({parameter.name: parameter.default for parameter in PARAMETERS})
    assert simulation.settings.operation.speed == 10.0 and not simulation.road_is_enough()
    assert usable.tolist() == [0.0, 4.0]
    assert text == find_vehicle().read_text(encoding="utf-8") and drive == ""


@pytest.mark.parametrize(
    ("vehicle", "words"),
    [
        ({("tracks", "links"): 130}, ("tracks.links x tracks.pitch is 14.950 m", "tensioners.travel of 0.1 m")),
        ({("ground", "stiffness"): 1e3, ("ground", "damping"): 0.0}, ("cannot roll at 10 m/s", "vehicle file")),
        ({("bodies", "turret", "inertia"): [8500.0, 11000.0, 30000.0]}, ("body 5 (turret)", "sum of the other two")),
        ({("coil", "delay"): 1.3e-7}, ("coil.delay is 1.3e-07 s", "whole number of physics steps of 0.0002 s")),
        ({("hull", "mass"): -1.0}, ("'vehicle_file'", "hull.mass is -1.0", "greater than 0")),
    ],
)
def test_impossible_vehicles_are_refused(refusal, vehicle, words):
    """A vehicle whose tracks do not fit, that cannot roll, or that cannot be, is refused in one line."""
    said = refusal(vehicle)
    assert said.startswith("simulator: ") and len(said.splitlines()) == 1
    for word in words:
        assert word in said


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"engine_speed": 100.0}, ("'engine_speed' is 100.0", "0 or 450 to 2100 r/min")),
        ({"measure_rate": 300}, ("control_rate 1000 Hz and measure_rate 300 Hz conflict",)),
        ({"control_rate": 999}, ("physics_rate 5000 Hz and control_rate 999 Hz conflict",)),
        ({"physics_rate": 999}, ("'physics_rate' is 999, accepted: 0 or at least 1000 Hz",)),
    ],
)
def test_values_that_do_not_fit_are_refused(refusal, values, words):
    """A value that does not fit the vehicle or another value is refused with what is accepted."""
    said = refusal(**values)
    for word in ("simulator: ", *words):
        assert word in said
