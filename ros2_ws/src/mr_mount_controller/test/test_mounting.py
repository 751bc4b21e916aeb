"""What a description of mounts may say, and what is made of mounts that nobody describes."""

import math

import pytest
from mr_mount_controller.laws.estimator import levers
from mr_mount_controller.mounting import PAIR, Kind, Mount, Mounting, described, undescribed
from trackvib_msgs.msg import Mount as MountMessage
from trackvib_msgs.msg import MountDescription

pytestmark = pytest.mark.property


def message(*mounts, turning=(True, True, True)):
    """A description of mounts (name, kind, place)."""
    told = MountDescription(turning=list(turning))
    for name, kind, place in mounts:
        told.mounts.append(MountMessage(name=name, kind=kind))
        told.mounts[-1].place.x, told.mounts[-1].place.y, told.mounts[-1].place.z = place
    return told


def test_numbers_of_kinds_are_those_of_the_message():
    """As the definition's constants have them."""
    assert [(kind.name, kind.value) for kind in Kind] == [("MR", MountMessage.MR), ("RUBBER", MountMessage.RUBBER)]


@pytest.mark.parametrize(("coils", "pads"), [(0, 0), (0, 4), (1, 0), (2, 2), (16, 16)])
def test_a_description_comes_back(coils, pads):
    """Names, kinds, places, and how many coils."""
    kinds = [Kind.MR] * coils + [Kind.RUBBER] * pads
    mounts = tuple(Mount(f"m{k}", kind, (0.1 * k, -0.2 * k, 1.0)) for k, kind in enumerate(kinds))
    found = described(message(*mounts, turning=(False, True, False)))
    assert found == Mounting(mounts, (False, True, False))
    assert (found.coils, len(found.mounts)) == (coils, coils + pads)


@pytest.mark.parametrize(
    ("mounts", "words"),
    [
        ([("a", 0, (0.0,) * 3)] * 2, "mount names are a, a, must be unique"),
        ([("", 0, (0.0,) * 3)], "a mount is called '', accepted: 1 to 64 characters"),
        ([("a\nb", 0, (0.0,) * 3)], r"a mount is called 'a\\nb'"),
        ([("n" * 65, 0, (0.0,) * 3)], "accepted: 1 to 64 characters"),
        ([("a", 7, (0.0,) * 3)], r"mount a is of kind 7, accepted: 0 \(MR\), 1 \(RUBBER\)"),
        ([("a", 0, (0.0, math.nan, 0.0))], "mount a is at .*nan.* accepted: up to 100 m"),
        ([("a", 0, (0.0, 1e9, 0.0))], "mount a is at .*accepted: up to 100 m"),
        ([("a", 1, (0.0,) * 3), ("b", 0, (0.0,) * 3)], "a rubber mount is described before a magnetorheological one"),
        ([(f"m{k}", 0, (0.0,) * 3) for k in range(17)], "17 magnetorheological mounts are described, accepted: 16"),
        ([(f"m{k}", 1, (0.0,) * 3) for k in range(33)], "33 mounts are described, accepted: at most 32"),
    ],
)
def test_nonsense_is_refused(mounts, words):
    """With what is wrong and what is accepted."""
    with pytest.raises(ValueError, match=words):
        described(message(*mounts))


def test_mounts_that_nobody_describes():
    """Two coils are the pair; other numbers have mounts called by them, where the sensors are."""
    assert undescribed(2) == undescribed(2, 2) == PAIR
    assert undescribed(3).names == ("mount 1", "mount 2", "mount 3")
    assert undescribed(2, 4).coils == 2 and len(undescribed(2, 4).mounts) == 4
    assert undescribed(0).coils == 0
    assert levers(undescribed(4)) == [(0.0, 0.0)] * 4


def test_levers_are_those_of_what_can_turn():
    """z = y about x, -x about y; none of what lies on the hinge, nor of a rubber mount."""
    mounts = (Mount("a", Kind.MR, (1.0, 2.0, 3.0)), Mount("pad", Kind.RUBBER, (4.0, 5.0, 6.0)))
    assert levers(Mounting(mounts)) == [(2.0, -1.0)]
    assert levers(Mounting(mounts, (False, True, False))) == [(0.0, -1.0)]
    assert levers(PAIR) == [(0.0, 0.0)] * 2
