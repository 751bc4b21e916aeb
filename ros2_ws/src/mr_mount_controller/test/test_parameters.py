"""Parameters: what each type accepts, and what a refusal says."""

import pytest
from mr_mount_controller.node_base.parameters import Parameter, ParameterError

GAIN = Parameter("gain", 1.0, "A gain.", "N s/m", 0.0, 5.0)
FREE = Parameter("offset", 0.0, "Any number.")
COUNT = Parameter("count", 3, "A count.", "", 1, 9)
SWITCH = Parameter("switch", False, "On or off.")
NAME = Parameter("name", "", "A name.")
CHOICE = Parameter("pace", "slow", "How fast.", choices=("slow", "fast"))
TOPICS = Parameter("topics", ["a"], "Topics.")


@pytest.mark.property
@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        (GAIN, 0.0), (GAIN, 5.0), (GAIN, 2.5), (FREE, -1e300), (COUNT, 1), (COUNT, 9), (SWITCH, True),
        (NAME, ""), (NAME, "x"), (CHOICE, "fast"), (TOPICS, []), (TOPICS, ["a", "b"]),
    ],
)  # fmt: skip
def test_good_values_come_back(parameter, value):
    """A value of the default's type within the range, its ends included, is returned as it is."""
    assert parameter.check(value) is value
    assert parameter.check(parameter.default) is parameter.default


@pytest.mark.property
@pytest.mark.parametrize(
    ("parameter", "value", "accepted"),
    [
        (GAIN, -1e-9, "a number from 0 to 5 N s/m"),
        (GAIN, 5.1, "from 0 to 5 N s/m"),
        (GAIN, 6, "a number from 0 to 5 N s/m"),
        (FREE, 2**60, "a number"),
        (GAIN, float("nan"), "from 0 to 5"),
        (GAIN, float("inf"), "from 0 to 5"),
        (GAIN, "1.0", "a number"),
        (GAIN, True, "a number"),
        (GAIN, None, "a number"),
        (FREE, float("nan"), "a number"),
        (FREE, float("-inf"), "a number"),
        (COUNT, 0, "a whole number from 1 to 9"),
        (COUNT, 10, "a whole number from 1 to 9"),
        (COUNT, 3.0, "a whole number"),
        (COUNT, True, "a whole number"),
        (SWITCH, 1, "true or false"),
        (SWITCH, "true", "true or false"),
        (NAME, 5, "a text"),
        (CHOICE, "medium", "one of slow, fast"),
        (CHOICE, 1, "one of slow, fast"),
        (TOPICS, "a", "a list of strings"),
        (TOPICS, ["a", 1], "a list of strings"),
    ],
)
def test_refusal_names_item_value_and_what_is_accepted(parameter, value, accepted):
    """A bad value is refused in a sentence with the parameter's name, the value and what would do."""
    with pytest.raises(ParameterError) as refused:
        parameter.check(value)
    message = str(refused.value)
    assert f"'{parameter.name}' is {parameter.converted(value)!r}" in message
    assert accepted in message


@pytest.mark.property
def test_a_whole_number_does_for_any_number():
    """As the floating-point number that is meant."""
    value = GAIN.check(3)
    assert value == 3.0 and type(value) is float
