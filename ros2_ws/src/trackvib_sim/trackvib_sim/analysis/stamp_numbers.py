"""What `analyze` says of the stamps in a bag, as plain data: see `numbers`."""

from dataclasses import dataclass

from .numbers import number


@dataclass(frozen=True)
class Gap:
    """A place where stamps of a topic jump ahead."""

    begin: float = number("s")  # last sample before it, from the start of the bag
    length: float = number("s")  # to the next sample
    missing: int = number("-")  # samples that should lie within


@dataclass(frozen=True)
class Timing:
    """What the stamps of a topic say, over the whole bag; those of answers are of the samples that they answer."""

    samples: int = number("-")
    period: float = number("s")  # median step of the stamps
    first: float = number("s")  # from the start of the bag
    last: float = number("s")
    missing: int = number("-")  # in all gaps
    repeated: int = number("-")  # samples within half a period of the one before
    backward: int = number("-")  # samples older than the one before
    gap_count: int = number("-")
    gaps: tuple  # the `Gap`s, up to `MOST_GAPS`

    @property
    def sound(self):
        """Whether each sample follows the one before by one period."""
        return not (self.gap_count or self.repeated or self.backward)


@dataclass(frozen=True)
class Clock:
    """What a sensor's stamps were like before they were put on the robust line through them."""

    rate: float = number("Hz")  # slope of the line
    jitter: float = number("s")  # RMS of the stamps about it
    correction: float = number("s")  # the largest
    lost: int = number("-")  # samples that are missing between others
    repeated: int = number("-")  # stamps that are those of the sample before
    disordered: int = number("-")  # samples that were put in the order of their stamps
    copies: int = number("-")  # messages that are in the bag twice, left out
    left_out: int = number("-")  # samples that stand apart, or next to lost ones
    settings: tuple  # by how much the clock was set [s], and whether the recorder's clock bears it out
    counted_by_log: bool  # whether samples were counted by the times at which they were recorded
    steps: str  # which steps the stamps make
