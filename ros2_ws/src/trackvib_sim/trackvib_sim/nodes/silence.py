"""A controller that does not answer: whether it is silent, and what the simulator does then (`on_silence`)."""

from mr_mount_controller.node_base.loop_node import NodeError

_ACTIONS = {"hold": "holding the last current", "passive": "falling back to the passive current"}
STOP = "stop"


class Silence:
    """Begins when no answer came in time; the loop then runs on without waiting, until somebody answers again."""

    def __init__(self, policy, passive_current, lockstep):
        """Take `on_silence`, the current [A] of its "passive", and the `Lockstep` whose currents it sets."""
        self._policy, self._passive_current, self._lockstep = policy, passive_current, lockstep
        self.now = False
        self.heard = self._heard_before = -1  # latest sample that somebody has answered, now and when silence fell, ns

    @property
    def lasts(self):
        """Whether nobody has answered since it fell."""
        return self.now and self.heard == self._heard_before

    def hear(self, stamp):
        """Take note of an answer to the sample of a time [ns]."""
        self.heard = max(self.heard, stamp)

    def begin(self, what):
        """Set the currents as the policy wants; returns a sentence that says so, after `what` was missed.

        Raises
        ------
        NodeError
            The policy is "stop".
        """
        self.now, self._heard_before = True, self.heard
        if self._policy == STOP:
            raise NodeError(f"{what}; on_silence is {STOP!r}")
        if self._policy == "passive":
            self._lockstep.fall_back(self._passive_current)
        return f"{what}; {_ACTIONS[self._policy]} until the controller answers again"

    def end(self):
        """Somebody answers."""
        self.now = False
