"""A sensor whose loop takes as long as it takes: its rate wanders by a few per cent, every stamp is true, none is lost.

Likeness of an inertial sensor on a microcontroller, whose period went from 15.2 to 14.0 ms within half a minute and
scattered by 0.6 ms.
"""

import numpy as np
import pytest
from mr_mount_controller.node_base.cdr import NANO
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.bags.reading import read_recording

from .foreign_bags import START, TOPICS, write_foreign


@pytest.mark.property
def test_a_rate_that_wanders_is_no_loss(tmp_path):
    """All of the drive counts, nothing is missing, the line at 20 Hz has its level."""
    random, samples = np.random.default_rng(5), 2000
    period = np.interp(np.arange(samples), (0, 200, 600, 1000, 1400, samples), (15.2, 14.9, 14.0, 14.5, 14.7, 14.1))
    period += np.clip(random.normal(scale=0.6, size=samples), -2.5, 3.5)
    stamp = START + np.round(np.cumsum(period) * 1e-3 * NANO).astype(np.int64)
    write_foreign(tmp_path / "bag_0.mcap", dict.fromkeys(TOPICS, stamp))
    found = analyse(read_recording(tmp_path))
    span = (stamp[-1] - stamp[0]) / NANO
    for sensor in ("chassis", "powertrain"):
        assert found.timing[f"{sensor}/imu"].missing == 0
        assert found.sensors[sensor]["z"].rms_raw == pytest.approx(np.sqrt(0.5), rel=0.02)
    assert found.duration == pytest.approx(span, abs=0.1) and found.measured > span - 4.0
