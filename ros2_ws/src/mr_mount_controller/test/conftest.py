"""What the controller's test files share."""

import pytest
from hypothesis import settings
from mr_mount_controller.laws.base import Sample

settings.register_profile("unit", deadline=None, database=None)
settings.load_profile("unit")


@pytest.fixture(scope="session")
def sample():
    """A function that returns a sample with given vertical accelerations on top of gravity."""

    def make(time, chassis=0.0, powertrain=0.0):
        return Sample(time, (0.0, 0.0, 9.81 + chassis), (0.0,) * 3, (0.0, 0.0, 9.81 + powertrain), (0.0,) * 3)

    return make
