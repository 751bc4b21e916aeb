"""Labels in pictures that do not touch one another: those of close lines are joined, those of rays moved along them."""

from typing import NamedTuple


def joined(places, width):
    """Return the indices of lines at places (n,) in groups, each of which has room for one label.

    A label is `width` wide and ends at the first line of its group.
    """
    groups = []
    for index in sorted(range(len(places)), key=places.__getitem__):
        if groups and places[index] - places[groups[-1][0]] < width:
            groups[-1].append(index)
        else:
            groups.append([index])
    return groups


class Box(NamedTuple):
    """What a label covers."""

    left: float
    bottom: float
    right: float
    top: float

    def touches(self, other):
        """Whether two boxes have anything in common."""
        across = self.left < other.right and other.left < self.right
        return across and self.bottom < other.top and other.bottom < self.top


def first_free(boxes, taken):
    """Return the first of some boxes that touches none of those taken; None if every one does."""
    return next((box for box in boxes if not any(map(box.touches, taken))), None)
