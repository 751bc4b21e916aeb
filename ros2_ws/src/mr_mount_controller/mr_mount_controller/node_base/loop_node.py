"""What every node of trackvib does alike: declared parameters, a bounded spin, a clean end on SIGINT and SIGTERM."""

import signal
import sys

import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy._rclpy_pybind11 import RCLError, UnknownROSArgsError
from rclpy.exceptions import ParameterException
from rclpy.experimental import EventsExecutor
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from .listener import Listener
from .parameters import Parameter, ParameterError
from .patience import Patience
from .plain_text import plain_line
from .shared_memory import remove_unfinished_segments

_ACCEPTED = (
    "accepted are --ros-args and then -p NAME:=VALUE, -r FROM:=TO, --params-file FILE, --log-level LEVEL "
    "and the others of ROS 2"
)
# rclpy declares these itself
_OF_EVERY_NODE = (
    Parameter("use_sim_time", False, "Take the time from /clock."),
    Parameter("start_type_description_service", True, "Tell the definitions of types."),
)
_TICK = 0.1  # s, after which a node that has nothing to do looks at its stop flag


class NodeError(RuntimeError):
    """What stops a node with a message for its user and a non-zero exit code."""


class LoopNode(Node):
    """A node with parameters from `Parameter` descriptions, driven by its own `run`."""

    def __init__(self, name, parameters):
        try:
            super().__init__(name)
        except ParameterException:  # whose words do not tell what is accepted
            for own in _OF_EVERY_NODE:
                if own.name in self._parameter_overrides:
                    _checked(own, self._parameter_overrides[own.name].value, name)
            raise
        self.settings = {parameter.name: self._declare(parameter) for parameter in parameters}
        self._inputs = []
        self.patience = None
        self.stopping = lambda: False

    def declare_more(self, parameters):
        """Declare further parameters, which depend on those known first; returns their values by name."""
        values = {parameter.name: self._declare(parameter) for parameter in parameters}
        self.settings |= values
        return values

    def listen(self, message_type, topic, on_message, qos, read=None):
        """Subscribe as `Listener` does; returns the subscription."""
        self._inputs.append(Listener(self, message_type, topic, on_message, qos, read))
        return self._inputs[-1].subscription

    @property
    def refused(self):
        """How many messages could not be used."""
        return sum(listener.refused for listener in self._inputs)

    def refuse_unknown_parameters(self):
        """Raise `ParameterError` for a value given to a parameter that the node does not have."""
        for name in self._parameter_overrides:  # rclpy has no public view of what was given but not declared
            if not self.has_parameter(name):
                known = ", ".join(sorted(self.settings))
                raise ParameterError(f"{self.get_name()}: there is no parameter '{name}'; known are {known}")

    def run(self):
        """Do the node's work until it is done or `self.stopping()`; by default answer callbacks."""
        while not self.stopping():
            self.spin_once(_TICK)

    def close(self):
        """Finish what must not be left half done; called once, whatever ended the node."""

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

    def _declare(self, parameter):
        descriptor = ParameterDescriptor(
            description=f"{parameter.description} [{parameter.unit}]" if parameter.unit else parameter.description,
            additional_constraints=f"accepted is {parameter.accepted}",
            read_only=True,
        )
        if parameter.low is not None:
            if isinstance(parameter.default, int):
                limits = IntegerRange(from_value=parameter.low, to_value=parameter.high, step=0)
                descriptor.integer_range = [limits]
            else:
                limits = FloatingPointRange(from_value=parameter.low, to_value=parameter.high, step=0.0)
                descriptor.floating_point_range = [limits]
        given = self._parameter_overrides.get(parameter.name)
        if given is not None:  # ROS tells 5 and 5.0 apart, and takes the one not for the other
            self._parameter_overrides[given.name] = RosParameter(given.name, value=parameter.converted(given.value))
        try:
            value = self.declare_parameter(parameter.name, parameter.default, descriptor).value
        except ParameterException:
            value = self._parameter_overrides[parameter.name].value
        return _checked(parameter, value, self.get_name())


def _checked(parameter, value, node):
    try:
        return parameter.check(value)
    except ParameterError as error:
        raise ParameterError(f"{node}: {error}") from None


def start_ros(args=()):
    """Start ROS 2 without signal handlers of its own, and without what killed processes left in its way.

    Raises
    ------
    ParameterError
        The arguments, the program's name first, are not those of ROS 2.
    """
    remove_unfinished_segments()
    set_logger_level("rcl", LoggingSeverity.FATAL)  # it says for itself, in more words, what the error says
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
    except UnknownROSArgsError as error:
        raise ParameterError(f"arguments of ROS 2 {error} are not known; {_ACCEPTED}") from None
    except RCLError as error:
        if "Couldn't parse" not in str(error):
            raise
        # what follows is a place in its parser's source
        reason = str(error).removeprefix("failed to initialize rcl: ").split(". Error:")[0].split(", at /")[0]
        raise ParameterError(f"arguments of ROS 2: {reason.rstrip('.')}; {_ACCEPTED}") from None
    except UnicodeEncodeError as error:
        raise ParameterError(f"argument {error.object!r} is no text in UTF-8; {_ACCEPTED}") from None
    finally:
        set_logger_level("rcl", LoggingSeverity.UNSET)
    if foreign := remove_ros_args(args)[1:]:
        raise ParameterError(f"arguments {foreign} are not known; {_ACCEPTED}")


def run_node(make_node, args=None, companions=()):
    """Make a node, run it until it ends or a signal asks it to, and return the process's exit code.

    Further nodes, made by `companions`, share its process and executor: they answer callbacks while it waits. The
    signals only set a flag, once; rclpy's own handlers end a node in the middle of whatever it does.
    """
    stop = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.append(True))
    nodes = []
    try:
        start_ros(sys.argv if args is None else args)
        executor = EventsExecutor()
        for make in (*companions, make_node):
            nodes.append(make())
            nodes[-1].refuse_unknown_parameters()
            nodes[-1].prepare(lambda timeout: executor.spin_once(timeout_sec=timeout), lambda: bool(stop))
            executor.add_node(nodes[-1])
        try:
            nodes[-1].run()
        finally:
            for node in reversed(nodes):
                node.close()
                if node.refused:
                    node.get_logger().warning(f"{node.refused} messages were refused")
            executor.shutdown()
    except (ParameterError, NodeError, RCLError) as error:
        print(f"error: {plain_line(str(error))}", file=sys.stderr)
        return 2 if isinstance(error, ParameterError) else 1
    finally:
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0
