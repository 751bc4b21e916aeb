"""`trackvib bag info` and `trackvib bag repair`, as a user calls them."""

import pytest
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from trackvib_sim.bags.qos import qos_record
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.nodes.messages import ImuMessage

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="each case starts the command line")

MESSAGES = 500
FILE = "drive_0.mcap"


@pytest.fixture
def bag(tmp_path):
    """A bag of half a second of one Imu."""
    writer, imu = BagWriter(tmp_path / "drive"), ImuMessage("chassis_imu_link")
    writer.add_provenance("versions", {"numpy": "0"})
    writer.add_attachment("vehicle.yaml", "name: test\n")
    writer.add_topic("/chassis/imu", "sensor_msgs/msg/Imu", [qos_record(LOOP_WRITER_QOS)], "RIHS01_0")
    for stamp in range(1_000_000, (MESSAGES + 1) * 1_000_000, 1_000_000):
        writer.write("/chassis/imu", stamp, imu.fill(stamp, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0)))
    writer.close()
    return tmp_path / "drive"


@pytest.fixture
def command(start_cli):
    """Run `trackvib bag` to its end: exit code and output."""

    def make(*arguments):
        process = start_cli("bag", *arguments)
        return process.wait(), process.output

    return make


def test_info(command, bag):
    """Topics, counts, times, and what made the bag."""
    code, output = command("info", bag)
    assert code == 0, output
    imu = ("/chassis/imu", "sensor_msgs/msg/Imu", f" {MESSAGES} ")
    for words in (*imu, "from 0.001 to 0.500 s", "zstd", "vehicle.yaml"):
        assert words in output


@SLOW
def test_cut_bag_is_repaired_once(command, bag):
    """It is named by `info`, completed by `repair`, with the file as it was kept, and sound then."""
    data = (bag / FILE).read_bytes()
    (bag / FILE).write_bytes(data[:-200])
    (bag / "metadata.yaml").unlink()
    code, output = command("info", bag)
    assert code == 1 and "was cut short" in output and "trackvib bag repair" in output
    code, output = command("repair", bag)
    assert code == 0 and f"{MESSAGES} messages kept" in output and f"{FILE}.damaged" in output
    assert (bag / f"{FILE}.damaged").read_bytes() == data[:-200]
    code, output = command("repair", bag)
    assert code == 0 and "sound, nothing to do" in output
    code, output = command("info", bag)
    assert code == 0 and "500" in output


@SLOW
def test_nonsense_is_refused(command, tmp_path):
    """A folder without bag, a file, and nothing at all: one error that names it, and nothing is made."""
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").write_text("text")
    for verb in ("info", "repair"):
        for name in ("empty", "file", "nowhere"):
            code, output = command(verb, tmp_path / name)
            assert code != 0 and name in output and "Traceback" not in output, output
    assert "is not an MCAP file" in command("info", tmp_path / "file")[1]
    assert list((tmp_path / "empty").iterdir()) == []
