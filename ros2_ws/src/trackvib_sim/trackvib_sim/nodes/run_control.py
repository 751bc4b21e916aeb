"""The simulator's state, and the services that change it: pause, resume, single step, reset."""

from std_srvs.srv import Trigger

from ..numerics.units import NANO


def services(step):
    """Return name, type and meaning of each service, `step` being what one takes a paused run further."""
    return tuple(
        (name, "std_srvs/srv/Trigger", meaning)
        for name, meaning in (
            ("pause", "Lets time stand still."),
            ("resume", "Lets a paused run go on."),
            ("step", f"Takes a paused run one {step} further."),
            ("reset", "Begins the run anew."),
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
    state : str
        One of waiting, running, paused, finished, stopped, failed; waiting is for partners or road.
    """

    def __init__(self, node, time):
        """Offer the services under the node's name; `time()` is the simulated time [ns] of the period at hand."""
        self.epoch = 1
        self.reset_wanted = False
        self.state = "waiting"
        self._paused = False
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
    def holding(self):
        """Whether the run is paused and no step is asked for."""
        return self._paused and self._steps == 0

    def end_period(self):
        """Note that a period was done."""
        self._steps = max(self._steps - 1, 0)

    def begin_epoch(self):
        """Note that the run begins anew; steps that were asked for before are forgotten."""
        self.epoch += 1
        self.reset_wanted, self._steps = False, 0

    def _pause(self, _request, response):
        self._paused = True
        return self._answer(response, "paused at")

    def _resume(self, _request, response):
        self._paused, self._steps = False, 0
        return self._answer(response, "resumed at")

    def _step(self, _request, response):
        if not self._paused:
            response.success, response.message = False, "a run that is not paused takes no single steps"
            return response
        self._steps += 1
        return self._answer(response, "one period on, from")

    def _reset(self, _request, response):
        if self.state == "waiting" and self._time() == 0:
            response.success, response.message = False, "the run has not begun"
            return response
        self.reset_wanted = True
        return self._answer(response, "reset at")

    def _answer(self, response, done):
        response.success, response.message = True, f"{done} t = {self._time() / NANO:.3f} s"
        self._logger.info(response.message)
        return response
