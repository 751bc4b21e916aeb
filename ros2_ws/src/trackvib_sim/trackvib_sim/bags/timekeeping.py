"""What the stamps of recorded messages tell: their time in the bag, how far it is complete, that a run begins anew."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import NANO, leading_stamp

# Their stamps are the simulation's own time, and go up by so many ns at least from message to message of one topic. If
# they do not, the simulation has begun anew.
_LEAST_STEP = {
    topics.IMU_TYPE: 1,
    topics.MOUNT_STATE_TYPE: 1,
    topics.CLOCK_TYPE: 0,
    topics.ODOMETRY_TYPE: 0,
}
# Others than the simulator may tell a time on its clock. Where its own words are recorded as well, these alone begin an
# epoch: they reach a recorder before the clock of the new run.
_ITS_OWN = frozenset(_LEAST_STEP) - {topics.CLOCK_TYPE}
# They come every period, or every so many periods, whatever the partners do.
_EVERY_PERIOD = (topics.IMU_TYPE, topics.MOUNT_STATE_TYPE)
_ANSWER = topics.COIL_CURRENT_TYPE
END_OF_TIME = (2**31 - 1) * NANO  # ns; the latest whole second that a stamp can hold
_END = 2**31 * NANO  # ns that a time can hold
_JUMP = 3600 * NANO  # ns; a stamp so far ahead is believed when the topic's next one agrees


class Timekeeping:
    """Follows the stamps of one epoch."""

    def __init__(self):
        self.latest = 0  # ns, of all stamps so far
        self._doubted = {}  # topic -> latest stamp far ahead of all others, ns
        self._keepers = {}  # topic -> latest stamp, ns
        self._paced = {}  # topic that comes every period, or every so many periods -> its least step, ns
        self._types = set()  # of the topics that are recorded
        self._answered = 0  # ns, latest stamp of an answer

    @property
    def complete_until(self):
        """Time [ns] up to which the samples are there: of several topics, the one that is the farthest behind.

        A topic that comes every so many periods is behind when its next message is due. `END_OF_TIME` if none are
        recorded, for then none is missing.
        """
        if self._types.isdisjoint(_EVERY_PERIOD):
            return END_OF_TIME
        behind = (stamp for topic, step in self._paced.items() if (stamp := self._keepers[topic]) + step <= self.latest)
        return min(behind, default=self.latest)

    @property
    def answered_until(self):
        """Time [ns] of the latest sample whose answer is there; `END_OF_TIME` if no answers are recorded."""
        # a stamp of its own that a controller makes up tells nothing
        return min(self._answered, self.latest) if _ANSWER in self._types else END_OF_TIME

    def announce(self, type_name):
        """Take note that a topic of some type is recorded."""
        self._types.add(type_name)

    def add(self, topic, type_name, stamped, data):
        """Take note of a serialised message; returns its time in the bag [ns], or None if it begins a new epoch.

        A message without a stamp (`stamped` false, or one that nobody filled in) has that of the latest one, and so has
        one whose stamp cannot be true: it is negative, all by itself far ahead, or a clock behind the others.
        """
        stamp = leading_stamp(data) if stamped else 0
        if not self._believable(topic, stamp):
            return self.latest
        least_step = _LEAST_STEP.get(type_name)
        if least_step is None or stamp < least_step:
            stamp = stamp or self.latest
            if type_name == _ANSWER:
                self._answered = max(self._answered, stamp)
            return stamp
        if stamp < self._keepers.get(topic, 0) + least_step:
            return self.latest if type_name == topics.CLOCK_TYPE and self._types & _ITS_OWN else None
        if type_name in _EVERY_PERIOD:
            step = stamp - self._keepers.get(topic, 0)
            self._paced[topic] = min(step, self._paced.get(topic, step))
        self._keepers[topic] = stamp
        self.latest = max(self.latest, stamp)
        return stamp

    def _believable(self, topic, stamp):
        if self.latest and stamp > self.latest + _JUMP:
            doubted, self._doubted[topic] = self._doubted.get(topic), stamp
            return stamp < _END and doubted is not None and 0 <= stamp - doubted <= _JUMP
        return 0 <= stamp < _END
