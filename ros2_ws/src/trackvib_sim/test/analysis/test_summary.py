"""What a summary says of a run: losses, settling, where the work on the mounts went."""

import numpy as np
import pytest
from trackvib_sim.analysis.loop_health import drive as drive_numbers
from trackvib_sim.analysis.loop_health import mount_energy
from trackvib_sim.analysis.settling import settling_time
from trackvib_sim.analysis.stamps import losses
from trackvib_sim.bags.recording import Answers, Inertial

from .made_recordings import made_recording

MS = 1_000_000  # ns


def drive(chassis, powertrain, answered, time):
    """Return a drive with these stamps [ms], whose simulator told its last time [s]."""
    sensors = [
        Inertial(np.array(stamps) * MS, np.zeros((len(stamps), 3)), np.zeros((len(stamps), 3)))
        for stamps in (chassis, powertrain)
    ]
    answers = Answers(np.array(answered) * MS, np.ones((len(answered), 2)))
    chassis, powertrain = sensors
    return made_recording(range(1, 101))._replace(
        chassis=chassis, powertrain=powertrain, odometry=None, answers=answers, diagnostics={"time": str(time)}
    )


@pytest.mark.property
def test_losses_are_counted_wherever_they_are():
    """Missing first, middle and last samples count, the last ones by the time that the simulator told at its end."""
    whole = list(range(1, 101))
    nothing = {"samples": 100, "lost_chassis": 0, "lost_powertrain": 0, "unanswered": 0, "answered_twice": 0}
    assert losses(drive(whole, whole, whole, 0.1)) == nothing
    counted = losses(drive(whole[:90], whole[3:], [*whole[:50], *whole[51:], 100], 0.1))
    assert counted == {"samples": 100, "lost_chassis": 10, "lost_powertrain": 3, "unanswered": 1, "answered_twice": 1}
    # of a bag that begins in the middle, an answer to the sample before its first one is none too many
    assert losses(drive(whole[10:], whole[10:], whole[9:], 0.1)) == nothing | {"samples": 90}


@pytest.mark.property
def test_answers_that_are_not_in_the_bag_are_not_counted():
    """Nobody knows then whether there were any."""
    whole = list(range(1, 101))
    counted = losses(drive(whole, whole, whole, 0.1)._replace(answers=None))
    assert counted["lost_chassis"] == 0 and (counted["unanswered"], counted["answered_twice"]) == (None, None)


@pytest.mark.analytic
@pytest.mark.parametrize(("speed", "seconds"), [(0.0, 2.0), (5.0, 3.7), (10.0, 2.0), (1.0, 18.5)])
def test_settling_ends_when_the_rear_wheels_are_on_the_roughness(speed, seconds):
    """16 m to the full roughness and 2.5 m of vehicle, at least 2 s."""
    assert settling_time(speed, 16.0) == pytest.approx(seconds)


@pytest.mark.property
def test_work_on_the_mounts_is_what_the_simulator_told():
    """Its diagnostics are text; what the account leaves over is set against its greatest part."""
    stamps = list(range(1, 101))
    parts = {"work": "92.0", "dissipated": "140.0", "stored": "-2.0", "exchanged": "-47.4"}
    told = {f"mount_{part}_J": energy for part, energy in parts.items()}
    found = mount_energy(drive(stamps, stamps, stamps, 0.1)._replace(diagnostics=told))
    assert found.residual == pytest.approx(1.4) and found.error == pytest.approx(0.01)
    assert found._replace(work=0.0, dissipated=0.0, stored=0.0, exchanged=0.0).error == 0.0


@pytest.mark.property
def test_drive_is_what_the_simulator_told():
    """Work over way and over time; no force of a vehicle that stood, nothing of a simulator that told nothing."""
    stamps = list(range(1, 101))
    recording = drive(stamps, stamps, stamps, 0.1)
    told = {"drive_work_J": "2000.0", "way_m": "100.0", "time": "8.0"}
    assert drive_numbers(recording._replace(diagnostics=told)) == (20.0, 250.0)
    stood = drive_numbers(recording._replace(diagnostics=told | {"way_m": "0.5"}))
    assert np.isnan(stood[0]) and stood[1] == 250.0
    assert np.isnan(drive_numbers(recording._replace(diagnostics={}))).all()
