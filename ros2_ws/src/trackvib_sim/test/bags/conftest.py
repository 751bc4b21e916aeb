"""What the tests of bags share: a small bag with real messages."""

import pytest
from mr_mount_controller.node_base.cdr import NANO
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from trackvib_sim.bags.qos import qos_record
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.nodes.messages import ImuMessage

from . import made_bags

TOPIC = "/chassis/imu"
QOS = [qos_record(LOOP_WRITER_QOS)]


@pytest.fixture(scope="session")
def write_bag():
    """Write a bag: `write_bag(folder, messages, compression=..., chunk_size=...)` returns the serialised messages.

    Chunks are of 16 messages or so by default; the bag has a metadata record and an attachment.
    """

    def make(folder, messages, compression="zstd", chunk_size=5000):
        bag = BagWriter(folder, compression, chunk_size)
        bag.add_provenance("versions", {"trackvib_sim": "0"})
        bag.add_attachment("vehicle.yaml", "name: test\n")
        bag.add_topic(TOPIC, "sensor_msgs/msg/Imu", QOS, "RIHS01_0")
        imu = ImuMessage("chassis_imu_link")
        written = []
        for k in range(1, messages + 1):
            # of numbers that do not compress to nothing
            written.append(imu.fill(k * NANO // 1000, (0.1 * k, k / 7.0, 9.81), (1.0 / k, 0.0, k**0.5)))
            bag.write(TOPIC, k * NANO // 1000, written[-1])
        bag.close()
        return written

    return make


@pytest.fixture(scope="session")
def bag(tmp_path_factory):
    """A bag of all topics of the loop, which nobody changes."""
    path = tmp_path_factory.mktemp("bags") / "bag"
    made_bags.write_bag(path, made_bags.PERIODS, vehicle="engine: none")
    return path
