"""The simulator's state, and the services that change it: pause, resume, single step, reset."""

from std_srvs.srv import Trigger

from ..numerics.units import NANO


def services(step):
    """Return name, type and meaning of each service, `step` being what one takes a paused run further."""
    return tuple(
        (name, "std_srvs/srv/Trigger", meaning)
        for name, meaning in (
            ("pause", "Pauses the run."),
            ("resume", "Resumes a paused run."),
            ("step", f"Advances a paused run by one {step}."),
            ("reset", "Restarts the run."),
        )
    )


class RunControl:
    """Knows in which state and epoch the run is and what the services ask for.

    A service only notes what is wanted and answers at once; the node does it between two periods. So no caller waits
    for road, controller or recorder, and every period that has begun is completed with its answer.

    Attributes
    ----------
    epoch : int
        How often the run has begun: 1, and one more with every reset.
    reset_wanted : bool
    quit_wanted : bool
    periods : int
        How many have been done since the node has begun.
    state : str
        One of waiting, running, paused, finished, stopped, failed; waiting is for partners or road.
    """

    def __init__(self, node, time):
        """Offer the services under the node's name; `time()` is the simulated time [ns] of the period at hand."""
        self.epoch = 1
        self.reset_wanted = self.quit_wanted = False
        self._state = "waiting"
        self._waiting = []  # for something to happen: pairs of a condition and what is told whether it has
        self._paused = False
        self.periods = 0
        self._steps = 0  # still to be done while paused
        self._time = time
        self._logger = node.get_logger()
        for name, service in (
            ("pause", self._pause),
            ("resume", self._resume),
            ("step", self._step),
            ("reset", self._reset),
        ):
            node.create_service(Trigger, f"~/{name}", service)

    @property
    def state(self):
        """See above."""
        return self._state

    @state.setter
    def state(self, state):
        self._state = state
        self.look()

    @property
    def paused(self):
        """Whether the run is paused, single steps or not."""
        return self._paused

    @property
    def begun(self):
        """Whether a period of the run has been done."""
        return self._time() > 0

    def when(self, condition, done):
        """Call `done()` as soon as `condition()`, now or between two periods."""
        self._waiting.append((condition, done))
        self.look()

    def pause(self):
        """Let time stand still after the period at hand."""
        self._paused = True

    def resume(self):
        """Go on; steps still to be done are none any more."""
        self._paused, self._steps = False, 0
        self.look()

    def add_steps(self, count):
        """Do so many periods more while paused."""
        self._steps += count

    def drop_steps(self, count):
        """Leave out so many of those still to be done."""
        self._steps = max(self._steps - count, 0)

    def reset(self):
        """Begin the run anew as soon as the period at hand is done."""
        self.reset_wanted = True

    def quit(self):
        """End the node as soon as the period at hand is done."""
        self.quit_wanted = True

    @property
    def holding(self):
        """Whether the run is paused and no step is asked for."""
        return self._paused and self._steps == 0

    def end_period(self):
        """Note that a period was done."""
        self._steps = max(self._steps - 1, 0)
        self.periods += 1
        self.look()

    def begin_epoch(self):
        """Note that the run restarts; steps that were asked for before are forgotten."""
        self.epoch += 1
        self.reset_wanted, self._steps = False, 0
        self.look()

    def look(self):
        """Tell who waits for something that it has happened."""
        happened = [each for each in self._waiting if each[0]()]
        self._waiting = [each for each in self._waiting if each not in happened]
        for _, done in happened:
            done()

    def _pause(self, _request, response):
        self.pause()
        return self._answer(response, "paused at")

    def _resume(self, _request, response):
        self.resume()
        return self._answer(response, "resumed at")

    def _step(self, _request, response):
        if not self._paused:
            response.success, response.message = False, "single steps need a paused run"
            return response
        self.add_steps(1)
        return self._answer(response, "one period, from")

    def _reset(self, _request, response):
        if self.state == "waiting" and not self.begun:
            response.success, response.message = False, "the run has not started"
            return response
        self.reset()
        return self._answer(response, "reset at")

    def _answer(self, response, done):
        response.success, response.message = True, f"{done} t = {self._time() / NANO:.3f} s"
        self._logger.info(response.message)
        return response
