"""What every node of trackvib does alike: declared parameters, a bounded spin, callbacks that may end it."""

from rcl_interfaces.msg import SetParametersResult
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter
from rclpy.task import Future

from .descriptors import descriptor_of
from .listener import Listener
from .parameter_files import given_by_wildcard
from .parameters import Parameter, ParameterError
from .patience import Patience
from .plain_text import plain_line, readable
from .suggestion import suggestion

# rclpy declares these itself
_OF_EVERY_NODE = (
    Parameter("use_sim_time", False, "Take the time from /clock."),
    Parameter("start_type_description_service", True, "Offer the service that describes message types."),
)
_TICK = 0.1  # s, after which a node that has nothing to do looks at its stop flag


class NodeError(RuntimeError):
    """What stops a node with a message for its user and a non-zero exit code."""


class LoopNode(Node):
    """A node with parameters from `Parameter` descriptions, driven by its own `run`.

    Attributes
    ----------
    NAME : str
        Class attribute: its name, where it is not remapped.
    PARAMETERS : tuple of Parameter
        Class attribute.
    SERVICES : tuple of (str, str, str)
        Class attribute: name, type and meaning of each, below the node's own name.
    settings : dict
        Values of the parameters by name.
    """

    NAME, PARAMETERS, SERVICES = "", (), ()

    def __init__(self):
        name = self.NAME
        try:
            super().__init__(name)
        except ParameterException:  # whose words do not tell what is accepted
            for own in _OF_EVERY_NODE:
                if own.name in self._parameter_overrides:
                    _checked(own, self._parameter_overrides[own.name].value, name)
            raise
        self._changeable, self._change = {}, None
        self.settings = {parameter.name: self._declare(parameter) for parameter in self.PARAMETERS}
        self._inputs = []
        self.failure = None  # what a callback has raised to end the node
        self._idle = Future()  # done, where a callback ends `serve`
        self.patience = None
        self.stopping = lambda: False

    @classmethod
    def parameters_by_title(cls):
        """Return the parameters that it may have, for its help: title -> descriptions."""
        return {f"parameters of {cls.NAME}": cls.PARAMETERS}

    def declare_changeable(self, parameters, change):
        """Declare further parameters, which may change while the node runs; returns their values by name.

        `change(values)` is called with new values that are acceptable one by one, between two other callbacks; it takes
        them all, or raises `ParameterError` and takes none.
        """
        values = {parameter.name: self._declare(parameter, fixed=False) for parameter in parameters}
        self.settings |= values
        self._changeable, self._change = {parameter.name: parameter for parameter in parameters}, change
        return values

    def set_parameters_atomically(self, parameter_list):
        """Change parameters that may change, all or none, as ROS's services ask; the others say that they are fixed."""
        try:
            asked = {each.name: self._accepted(each) for each in parameter_list}
            known = {name: value for name, value in asked.items() if name in self._changeable}
            if known:
                self._change(known)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=plain_line(str(error)))
        self.settings |= known
        return super().set_parameters_atomically([RosParameter(name, value=value) for name, value in asked.items()])

    def _accepted(self, asked):
        if asked.name in self._changeable:
            return self._changeable[asked.name].check(asked.value)
        if self.has_parameter(asked.name):
            raise ParameterError(f"parameter '{asked.name}' is fixed while the node runs; give it at the node's start")
        known = ", ".join(sorted(self._changeable)) or "none"
        meant = suggestion(asked.name, self._changeable)
        raise ParameterError(f"unknown parameter '{asked.name}'; parameters that may change are: {known}{meant}")

    def listen(self, message_type, topic, on_message, qos, read=None):
        """Subscribe as `Listener` does; returns the subscription."""

        def take(message):
            try:
                if self.failure is None:
                    on_message(message)
            except NodeError as error:  # raised later: what leaves a callback is logged at length
                self.failure = error
                self.stop_serving()

        self._inputs.append(Listener(self, message_type, topic, take, qos, read))
        return self._inputs[-1].subscription

    @property
    def refused(self):
        """How many messages could not be used."""
        return sum(listener.refused for listener in self._inputs)

    def refuse_unknown_parameters(self, arguments):
        """Raise `ParameterError` for a value given to a parameter that the node does not have.

        What files among the arguments give to many nodes at once is meant for others, and named once.
        """
        # rclpy has no public view of what was given but not declared
        unknown = [name for name in self._parameter_overrides if not self.has_parameter(name)]
        of_others = given_by_wildcard(arguments) if unknown else ()
        for name in unknown:
            if name not in of_others:
                known = ", ".join(sorted(self.settings))
                meant = suggestion(name, self.settings)
                raise ParameterError(f"{self.get_name()}: unknown parameter '{name}'; known are {known}{meant}")
        if unknown:
            names = readable(", ".join(sorted(unknown)))
            self.get_logger().warning(
                f"a parameter file for several nodes contains parameters that this node does not have: {names}"
            )

    def run(self):
        """Do the node's work until it is done or `self.stopping()`; by default answer callbacks."""
        while not self.stopping():
            self.serve(_TICK)

    def raise_failure(self):
        """Raise what a callback has raised to end the node."""
        if self.failure is not None:
            raise self.failure

    def close(self):
        """Finish what must not be left half done; called once, whatever ended the node."""

    def serve(self, timeout):
        """Serve all callbacks that wait, and those that come within `timeout` seconds, until `stop_serving`.

        In one go: a call for each message costs as much as the message.
        """
        self._idle = Future()
        self.executor.spin_until_future_complete(self._idle, timeout_sec=timeout)
        self.raise_failure()

    def stop_serving(self):
        """End `serve` after the callback at hand."""
        self._idle.set_result(None)

    def spin_once(self, timeout):
        """Serve callbacks that wait; if none does, wait for one for at most `timeout` seconds."""
        self.patience.look(timeout)

    def spin_until(self, condition, timeout=None):
        """Serve callbacks until `condition()`; returns whether it came true before a stop or the timeout [s]."""
        self.patience.wait_until(lambda: condition() or self.stopping(), timeout)
        return condition()

    def prepare(self, spin, stopping):
        """Hand in the executor's spin function and the stop flag."""
        self.patience, self.stopping = Patience(spin), stopping

    def _declare(self, parameter, fixed=True):
        given = self._parameter_overrides.get(parameter.name)
        if given is not None and (value := parameter.converted(given.value)) is not given.value:
            # ROS tells 5 and 5.0 apart, and takes the one not for the other
            self._parameter_overrides[given.name] = RosParameter(given.name, value=value)
        try:
            value = self.declare_parameter(parameter.name, parameter.default, descriptor_of(parameter, fixed)).value
        except ParameterException:
            value = self._parameter_overrides[parameter.name].value
        return _checked(parameter, value, self.get_name())


def _checked(parameter, value, node):
    try:
        return parameter.check(value)
    except ParameterError as error:
        raise ParameterError(f"{node}: {error}") from None
