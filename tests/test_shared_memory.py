"""System: shared memory that a killed process left unfinished does not hold up the next one."""

import signal
from pathlib import Path

import pytest
from mr_mount_controller.node_base.shared_memory import remove_unfinished_segments

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="starts nodes")

SIZE = 52_400  # bytes of a port's segment
HALVES = {"empty": b"", "blank": bytes(SIZE), "begun": bytes((1, 0, 0, 0)) + bytes(SIZE - 4)}


def ports(domain):
    """The segments of the first participants of a ROS domain (ports by the DDS standard's rule)."""
    return [Path(f"/dev/shm/fastrtps_port{7400 + 250 * domain + 10 + number}") for number in range(6)]


@SLOW
@pytest.mark.parametrize("half", HALVES)
def test_node_starts_beside_unfinished_segments(start_node, domain, half):
    for path in ports(domain):
        path.unlink(missing_ok=True)
        path.write_bytes(HALVES[half])
    try:
        node = start_node("road_excitation")
        node.wait_for("waiting for a vehicle")
        node.signal(signal.SIGINT)
        assert node.wait() == 0
    finally:
        for path in ports(domain):
            path.unlink(missing_ok=True)


def test_finished_segments_and_locks_stay(tmp_path):
    """Whatever is in use, or is no segment, is left alone."""
    kept = {
        "fastrtps_port7411": bytes((2, 0, 0, 0)) + bytes(60),
        "fastrtps_port7411_el": b"",
        "sem.fastrtps_port7411_mutex": bytes(32),
        "fastrtps_0123456789abcdef": bytes((2, 0, 0, 0, 1)),
        "other": b"",
    }
    for name, content in {**kept, "fastrtps_port7413": b"", "fastrtps_port7415": bytes(8)}.items():
        (tmp_path / name).write_bytes(content)
    remove_unfinished_segments(tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == kept
