"""What commands print and draw, compared with what documents show, but for what is of the moment."""

import re

import numpy as np
from matplotlib.image import imread
from trackvib_sim.numerics.processor import target

# Documents are renewed on processors of this level, all of which give the same bits (`numerics/processor.py`).
SAME_BITS = target() == "x86-64-v4"
SCATTER_OF_WORK = 0.2  # of the largest number in the account
# lines of progress, pace and places
OF_THE_MOMENT = ("finished", "runs ", "reading ", "measuring ", "pace:", "written to", "picture")
BEYOND = "!"  # marks a number that is beyond its goal
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?%?")


def compared(text):
    """Return what is to be compared: lines without those of the moment, frames of tables and marks of goals."""
    lines = (re.sub(r"[\u2500-\u257f\s]+", " ", line.replace(BEYOND, "")).strip() for line in text.splitlines())
    return [line for line in lines if line and not line.startswith(("```", *OF_THE_MOMENT))]


def alike(shown, printed, scatter):
    """Whether two lines have the same words, and numbers that differ by no more than they may.

    Whole numbers count or choose and must be the same; parts in percent may differ by one.
    """
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    old, new = ([float(each.rstrip("%")) for each in NUMBER.findall(line)] for line in (shown, printed))
    allowed = [_rounding(each) for each in NUMBER.findall(shown)]
    if scatter:
        work = SCATTER_OF_WORK * max(map(abs, old), default=0.0)
        allowed = [
            unit + (work if shown.startswith("mounts:") else scatter * abs(number)) if unit else 0.0
            for unit, number in zip(allowed, old, strict=True)
        ]
    return all(abs(a - b) <= most * (1.0 + 1e-9) for a, b, most in zip(old, new, allowed, strict=True))


def _rounding(number):
    if number.endswith("%"):
        return 1.0
    digits = len(number.partition(".")[2])
    return 10.0**-digits if digits else 0.0


def elements(path):
    """Return the elements of a picture, of an animated one those of its first frame, from 0 to 1."""
    picture = imread(path)
    return picture / 255.0 if picture.dtype == np.uint8 else picture
