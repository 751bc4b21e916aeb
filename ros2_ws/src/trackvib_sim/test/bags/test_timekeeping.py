"""Property and analytic: what the stamps of recorded messages tell."""

import pytest
from builtin_interfaces.msg import Time
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import serialize_message
from trackvib_sim.bags.timekeeping import END_OF_TIME, Timekeeping

IMU, MOUNTS = "sensor_msgs/msg/Imu", "trackvib_msgs/msg/MountState"
CLOCK, ANSWER = "rosgraph_msgs/msg/Clock", "trackvib_msgs/msg/CoilCurrent"
PERIODS = [("/chassis/imu", IMU), ("/powertrain/imu", IMU), ("/mount_state", MOUNTS)]
MS = 1_000_000


def stamped(stamp):
    return serialize_message(Time(sec=stamp // 10**9, nanosec=stamp % 10**9))


def recorded(*type_names):
    times = Timekeeping()
    for type_name in type_names:
        times.announce(type_name)
    return times


@pytest.mark.property
@given(st.lists(st.sampled_from([0, 1, 2]), min_size=1, max_size=60))
def test_progress_is_that_of_the_slowest_topic(order):
    """In whatever order the topics' messages come, all that every topic has up to `complete_until` has come."""
    times, count = recorded(IMU, MOUNTS, CLOCK), [0, 0, 0]
    for which in order:
        count[which] += 1
        topic, type_name = PERIODS[which]
        assert times.add(topic, type_name, True, stamped(count[which] * MS)) == count[which] * MS
        times.add("/clock", CLOCK, True, stamped(max(count) * MS))
        assert times.complete_until == min(each for each in count if each) * MS
        assert times.latest == max(count) * MS


@pytest.mark.property
@given(st.integers(1, 20), st.lists(st.booleans(), min_size=1, max_size=80))
def test_a_slow_sensor_holds_nothing_up_before_it_is_due(divisor, lost):
    """All that was due up to `complete_until` has come, of a sensor that reads every so many periods as well."""
    times, came = recorded(IMU), 0
    for k, lose in enumerate(lost, 1):
        times.add("/chassis/imu", IMU, True, stamped(k * MS))
        if k % divisor == 0 and not (lose and came):
            came = k
            times.add("/seat/imu", IMU, True, stamped(k * MS))
        due = k - k % divisor
        assert times.complete_until == (k if came == due else came) * MS


def test_without_topics_of_every_period():
    """Nothing of them is missing, ever; as long as none has come, the latest of all stamps counts."""
    assert recorded(CLOCK).complete_until == END_OF_TIME
    times = recorded(CLOCK, IMU)
    assert times.complete_until == 0
    times.add("/clock", CLOCK, True, stamped(5 * MS))
    assert times.complete_until == 5 * MS


def test_answers_do_not_hold_the_progress():
    """A controller may be silent, so its answers do not count, nor do their stamps make an epoch."""
    times = recorded(IMU, ANSWER)
    times.add("/chassis/imu", IMU, True, stamped(7 * MS))
    assert times.add("/coil_current", ANSWER, True, stamped(2 * MS)) == 2 * MS
    assert times.add("/coil_current", ANSWER, True, stamped(1 * MS)) == 1 * MS
    assert times.complete_until == 7 * MS and times.answered_until == 2 * MS


def test_progress_of_the_answers():
    """That of the latest one, at most up to the samples; without answers there is nothing to wait for."""
    assert recorded(IMU).answered_until == END_OF_TIME
    times = recorded(IMU, ANSWER)
    assert times.answered_until == 0
    times.add("/coil_current", ANSWER, True, stamped(9 * MS))
    assert times.answered_until == 0
    times.add("/chassis/imu", IMU, True, stamped(5 * MS))
    assert times.answered_until == 5 * MS


@pytest.mark.parametrize(("type_name", "same_again"), [(IMU, True), (MOUNTS, True), (CLOCK, False)])
def test_new_epoch(type_name, same_again):
    """Time that goes back begins one; so does a sample that comes twice, but not a clock."""
    times = Timekeeping()
    times.add("/topic", type_name, True, stamped(7 * MS))
    assert (times.add("/topic", type_name, True, stamped(7 * MS)) is None) == same_again
    assert times.add("/topic", type_name, True, stamped(6 * MS)) is None


def test_a_clock_beside_samples_begins_no_epoch():
    """Anybody can tell a time on it: one that goes back has the latest time, and changes nothing for what follows."""
    times = recorded(IMU, CLOCK)
    for k in (7, 8):
        assert times.add("/chassis/imu", IMU, True, stamped(k * MS)) == k * MS
        assert times.add("/clock", CLOCK, True, stamped(k * MS)) == k * MS
        for wrong in (0, 5):
            assert times.add("/clock", CLOCK, True, stamped(wrong * MS)) == k * MS
    assert times.complete_until == 8 * MS
    assert times.add("/chassis/imu", IMU, True, stamped(1 * MS)) is None


def test_message_without_stamp_has_that_of_the_latest():
    """Of no stamp, and of one that nobody filled in."""
    times = Timekeeping()
    times.add("/chassis/imu", IMU, True, stamped(3 * MS))
    assert times.add("/text", "std_msgs/msg/String", False, b"") == 3 * MS
    assert times.add("/answer", ANSWER, True, stamped(0)) == 3 * MS


HOUR = 3600 * 10**9


@pytest.mark.property
@pytest.mark.parametrize("type_name", [IMU, CLOCK, ANSWER])
@pytest.mark.parametrize("stamp", [-1, -(2**31) * 10**9, 8 * MS + HOUR, 2**31 * 10**9 - 1])
def test_one_absurd_stamp_changes_nothing(type_name, stamp):
    """It is recorded at the latest good time; before it and after it the times are those of the stamps."""
    times = Timekeeping()
    times.announce(IMU)
    assert times.add("/topic", IMU, True, stamped(7 * MS)) == 7 * MS
    assert times.add("/other", type_name, True, stamped(stamp)) == 7 * MS
    assert times.add("/topic", IMU, True, stamped(8 * MS)) == 8 * MS
    assert times.add("/other", type_name, True, stamped(8 * MS)) == 8 * MS
    assert times.complete_until == 8 * MS


@pytest.mark.property
def test_a_jump_that_goes_on_is_believed():
    """Time of another clock, or of a bag with a long gap, from its second message on."""
    times = Timekeeping()
    times.add("/topic", IMU, True, stamped(7 * MS))
    later = 5 * HOUR
    stamps = [times.add("/topic", IMU, True, stamped(later + k * MS)) for k in range(3)]
    assert stamps == [7 * MS, later + MS, later + 2 * MS]
