"""Subscriptions to whoever sends: a message that cannot be used never ends a node."""

from rclpy.serialization import deserialize_message

from .cdr import Checker, LayoutError
from .definitions import installed_definition


class Refused(ValueError):
    """A message that makes no sense; says what is wrong and what is accepted."""


class Listener:
    """A subscription whose messages are looked at before they are used: what is refused is said once, and counted.

    Messages are taken as bytes and checked first. ROS itself makes room for whatever length they claim, which can be
    gigabytes, and raises where they end early.

    Parameters
    ----------
    node : Node
    message_type : type
    topic : str
    on_message : callable
        Takes what `read` returns; may raise `Refused`.
    qos : QoSProfile or int
    read : callable, optional
        From bytes to what `on_message` takes; may raise `LayoutError`. By default the message itself is read.

    Attributes
    ----------
    subscription : Subscription
    refused : int
        Messages so far.
    """

    def __init__(self, node, message_type, topic, on_message, qos, read=None):
        self.refused = 0
        self._on_message, self._read, self._logger = on_message, read or whole_message(message_type), node.get_logger()
        self.subscription = node.create_subscription(message_type, topic, self._take, qos, raw=True)

    def _take(self, data):
        try:
            self._on_message(self._read(data))
        except (LayoutError, Refused) as error:
            self.refused += 1
            if self.refused == 1:
                topic = self.subscription.topic_name
                self._logger.error(f"message on {topic} refused: {error}; further ones are counted")


def whole_message(message_type):
    """Return the function that reads a message of a type from bytes; it raises `LayoutError` if they are none."""
    checker = Checker(installed_definition(message_type))
    return lambda data: deserialize_message(checker.check(data), message_type)
