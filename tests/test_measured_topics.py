"""What is measured in the running gear, over real DDS and in a bag; the run has the bits of one without it."""

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from rclpy.serialization import deserialize_message
from trackvib_msgs.msg import Measured, MeasuredDescription
from trackvib_sim.nodes.loop_arguments import closed_loop_parameters

from .processes import trackvib

pytestmark = pytest.mark.system

RATE, DURATION = 100, 0.6
TENSION = topics.measured_topic("track_tension")


@pytest.fixture
def driven(start_node, observer, tmp_path):
    """A bag with the running gear measured, and what an observer got meanwhile: description and tensions."""
    pattern = yaml.safe_load(closed_loop_parameters().read_text())["/**/recorder"]["ros__parameters"]["pattern"]
    description = observer.collect(MeasuredDescription, topics.MEASURED_DESCRIPTION, LATCHED_QOS)
    tension = observer.collect(Measured, TENSION, LOOP_WRITER_QOS)
    recorder = start_node("recorder", bag=tmp_path / "bag", pattern=f"'{pattern}'")
    start_node("road_excitation")
    simulator = start_node("simulator", measure_rate=RATE, duration=DURATION, wait_for_recorder=True)
    observer.wait_until(lambda: observer.node.count_publishers(TENSION))
    start_node("controller", wait_for_recorder=True)
    observer.wait_for(state="finished")
    observer.wait_until(lambda: description and tension)
    assert simulator.wait() == 0, simulator.output
    recorder.signal(2)
    assert recorder.wait() == 0, recorder.output
    return (
        tmp_path / "bag",
        deserialize_message(description[0], MeasuredDescription),
        [deserialize_message(data, Measured) for data in tension],
    )


@pytest.mark.slow(reason="two runs of real processes")
def test_kinds_travel_are_recorded_and_change_nothing(driven):
    """Each kind has its topic and as many numbers as names; a foreign reader finds them in the bag, at their rate; and
    the bag drives again without them bit for bit."""
    bag, description, heard = driven
    names = {f"/{kind.topic}": list(kind.names) for kind in description.kinds}
    kinds = ("suspension_travel", "damper_force", "wheel_force", "ground_force", "track_tension", "sprocket_torque",
             "engine_speed")  # fmt: skip
    assert list(names) == [f"/{topics.measured_topic(kind)}" for kind in kinds]
    assert all(kind.unit and kind.meaning for kind in description.kinds)
    found = {topic: [] for topic in names}
    with (bag / "bag_0.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages(topics=list(names)):
            stamp = decoded.header.stamp.sec * 10**9 + decoded.header.stamp.nanosec
            assert message.log_time == stamp
            found[channel.topic].append((stamp, list(decoded.value)))
    stamps = [10**9 // RATE * (k + 1) for k in range(round(DURATION * RATE))]
    for topic, messages in found.items():
        assert [stamp for stamp, _ in messages] == stamps
        values = np.array([value for _, value in messages])
        assert values.shape == (len(stamps), len(names[topic])) and np.isfinite(values).all()
    assert [list(each.value) for each in heard] == [value for _, value in found[f"/{TENSION}"][-len(heard) :]]
    assert "identical to the last bit" in trackvib("replay", bag, "--verify")
