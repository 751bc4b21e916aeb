"""`trackvib replay --verify`: what was recorded must come out again to the last bit, and one wrong bit is found."""

import shutil
import signal
import sys
from pathlib import Path

import pytest
from mr_mount_controller.node_base.cdr import leading_stamp
from rich.console import Console
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.commands.replay_verify import verify

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="drives whole runs again")

STAMP = 2_000_000_000  # ns, of the message that is spoilt


def check(bag):
    """Verify in this process."""
    return verify(bag, Console(quiet=True))


def test_a_recorded_run_comes_out_again(start_cli, recorded_run):
    """One line and exit code 0."""
    replay = start_cli("replay", recorded_run / "bag", "--verify")
    assert replay.wait() == 0, replay.output
    (verdict,) = replay.output.splitlines()
    assert "identical to the last bit: 3200 of /mount_state, 3200 of /chassis/imu, 3200 of /powertrain/imu" in verdict


@pytest.mark.slow(reason="a replay for each bit")
@pytest.mark.parametrize(
    ("topic", "byte", "mask", "words"),
    [
        ("/chassis/imu", -88, 1, "at t = 2.000 s linear_acceleration.y of /chassis/imu"),
        ("/powertrain/imu", -192, 1, "at t = 2.000 s angular_velocity.x of /powertrain/imu"),
        ("/mount_state", -32, 1, "at t = 2.000 s force.right.z of /mount_state"),
        ("/mount_state", -1, 128, "at t = 2.000 s dissipated_power.right of /mount_state"),
        ("/coil_current", -10, 1, "at t = 2.001 s current.left of /mount_state"),
    ],
)
def test_one_bit_is_found(edited, topic, byte, mask, words):
    """The first difference is named with its time and channel, be it in a sample or in an answer."""

    def flip(at, data):
        if at != topic or leading_stamp(data) != STAMP:
            return data
        spoilt = bytearray(data)
        spoilt[byte] ^= mask
        return bytes(spoilt)

    bag = edited(flip)
    identical, verdict = check(bag)
    assert not identical and verdict.startswith(f"different: {words}"), verdict


@SLOW
def test_a_difference_is_told_by_exit_code(start_cli, edited):
    """Of the command: exit code 1 and one line."""

    def spoil(topic, data):
        return data[:-1] + b"\x01" if topic == "/mount_state" and leading_stamp(data) == STAMP else data

    replay = start_cli("replay", edited(spoil), "--verify")
    assert replay.wait() == 1, replay.output
    assert "different: at t = 2.000 s dissipated_power.right of /mount_state is" in replay.output


@SLOW
def test_a_bag_that_is_cut_short(recorded_run, tmp_path):
    """What there is of it is verified, and it is said that there is no more."""
    bag = tmp_path / "cut"
    bag.mkdir()
    whole = (recorded_run / "bag" / "bag_0.mcap").read_bytes()
    (bag / "bag_0.mcap").write_bytes(whole[: len(whole) * 3 // 4])
    assert 1000 < len(read_recording(bag).chassis.stamp) < 3200
    identical, verdict = check(bag)
    assert identical and "cut short" in verdict


@SLOW
def test_lost_samples_do_not_hide_the_others(edited):
    """A message that is not in the bag is not compared; those after it are."""
    bag = edited(lambda topic, data: None if topic == "/chassis/imu" and leading_stamp(data) == STAMP else data)
    identical, verdict = check(bag)
    assert identical and "3200 of /mount_state, 3199 of /chassis/imu" in verdict


def without(topic):
    return {"message": lambda at, data: None if at == topic else data}


def told(name, key, value):
    return {"provenance": lambda at, values: values | {key: value} if at == name else values}


@SLOW
@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (without("/mount_state"), "holds no messages on mount_state"),
        (without("/road_profile"), "holds no messages on road_profile"),
        (without("/coil_current"), "no answer to the sample at t = 0.001 s is recorded"),
        (without("/diagnostics"), None),
        (told("parameters of /simulator", "pace", "realtime"), "pace is 'realtime'"),
        (
            told("parameters of /simulator", "physics_rate", "10"),
            "'physics_rate' is 10, accepted: 0 or at least 1000 Hz",
        ),
        ({"provenance": lambda name, values: None}, "does not hold the parameters of its simulator"),
        ({"message": lambda at, data: data[:30] if at == "/vehicle_description" else data}, "cannot be read"),
    ],
)
def test_what_cannot_be_verified(edited, edit, words):
    """One reason each; where the simulator's own counts are missing but no answer is, they are not needed."""
    bag = edited(**edit)
    if words is None:
        assert check(bag)[0]
        return
    with pytest.raises((BagError, ValueError), match=words):
        check(bag)


@SLOW
def test_a_missing_answer_is_no_silence(edited):
    """An answer that was lost on its way into the bag ends the verification there, and says how far it went."""
    bag = edited(lambda topic, data: None if topic == "/coil_current" and leading_stamp(data) == STAMP else data)
    with pytest.raises(ValueError, match=r"t = 2.000 s is recorded.*up to t = 2.000 s it is identical"):
        check(bag)


@SLOW
def test_other_versions_are_named(edited):
    """They are a note; the verdict is about the bits."""
    identical, verdict = check(edited(**told("versions", "numpy", "1.0")))
    assert identical and "made with numpy 1.0 (here" in verdict


@SLOW
@pytest.mark.parametrize("content", [None, b"", b"nonsense", b"\x89MCAP0\r\n"])
def test_nonsense_is_refused(start_cli, tmp_path, content):
    """One clear error and exit code 2."""
    bag = tmp_path / "bag"
    if content is not None:
        bag.mkdir()
        (bag / "bag_0.mcap").write_bytes(content)
    replay = start_cli("replay", bag, "--verify")
    assert replay.wait() == 2
    assert replay.output.startswith(f"cannot be verified: bag '{bag}'") and "Traceback" not in replay.output


@SLOW
def test_a_run_is_no_bag(start_cli, recorded_run):
    """But it is clear what is meant."""
    replay = start_cli("replay", recorded_run, "--verify")
    assert replay.wait() == 2
    assert f"holds no .mcap file; did you mean '{recorded_run / 'bag'}'?" in replay.output


@SLOW
def test_interrupted_at_any_moment(start, recorded_run):
    """Also while it is still loading its libraries: one word, and no code that stands for a verdict."""
    replay = start([sys.executable, "-m", "trackvib_sim.cli", "replay", recorded_run / "bag", "--verify"])
    while "zstandard" not in Path(f"/proc/{replay.pid}/maps").read_text():  # needed first by what a verb does
        assert replay.running
    replay.signal(signal.SIGINT)
    assert replay.wait() in (130, -signal.SIGINT)  # Python at times ends itself by the signal; to shells both are 130
    assert replay.output == "interrupted\n"


@SLOW
@pytest.mark.parametrize("policy", ["hold", "passive"])
def test_a_killed_controller(start_node, observer, tmp_path, policy):
    """The currents in force while nobody answers are those that the policy gave, and again the controller's after."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    controller = start_node("controller", law="skyhook", wait_for_recorder=True)
    quick = {"on_silence": policy, "answer_timeout": 0.2, "passive_current": 1.5}
    simulator = start_node("simulator", duration=3.0, wait_for_recorder=True, **quick)
    observer.wait_for(state="waiting")  # else it may find the simulator only when the run is over
    start_node("road_excitation")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.3)
    # standing, for the last answer of a controller killed while it sends need not reach the recorder
    observer.call("pause")
    observer.wait_for(state="paused")
    controller.signal(signal.SIGKILL)
    observer.call("resume")
    observer.wait_until(lambda: int(observer.values["silent_periods"]) > 100)
    start_node("controller", law="skyhook", wait_for_recorder=True)
    assert simulator.wait() == 0, simulator.output
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0
    silent = int(read_recording(tmp_path / "bag").loop_counts.silent_periods[-1])
    assert 100 < silent < 3000
    assert check(tmp_path / "bag")[0]


@SLOW
def test_each_epoch_is_verified(start_node, observer, tmp_path):
    """A run that was reset leaves two bags, and both come out again."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("controller", law="skyhook")
    simulator = start_node("simulator", duration=2.5, wait_for_recorder=True)
    observer.wait_for(state="waiting")
    observer.client("reset")
    start_node("road_excitation")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.3)
    observer.call("reset")
    assert simulator.wait() == 0, simulator.output
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0
    for bag in ("bag", "bag_epoch_2"):
        identical, verdict = check(tmp_path / bag)
        assert identical, verdict


@SLOW
def test_nothing_compared_is_no_verdict(edited):
    """Without answers a drive cannot begin, however short it is and however late its samples begin."""

    def late(topic, data):
        if topic in ("/chassis/imu", "/powertrain/imu", "/mount_state"):
            return data if 500_000_000 < leading_stamp(data) < 900_000_000 else None
        return None if topic == "/coil_current" else data

    with pytest.raises(ValueError, match="no answer to the sample at t = 0.001 s"):
        check(edited(late))


@SLOW
def test_two_runs_in_one_bag_are_refused(recorded_run, tmp_path):
    """As a recorder that knows nothing of epochs would leave them."""
    bag = tmp_path / "both"
    bag.mkdir()
    for number in range(2):
        shutil.copy(recorded_run / "bag" / "bag_0.mcap", bag / f"both_{number}.mcap")
    with pytest.raises(BagError, match="more than one run"):
        check(bag)
