"""Which topics a recorder takes: those it is told by name, and those whose name a regular expression finds."""

import re
from typing import NamedTuple

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import Checker, LayoutError
from mr_mount_controller.node_base.definitions import installed_definition
from mr_mount_controller.node_base.parameters import ParameterError
from rclpy.exceptions import InvalidTopicNameException
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.validate_topic_name import validate_topic_name

from ..bags.qos import qos_record
from .messages import message_type

_DEPTH = 10_000  # messages that may wait: a disk may stand still for a moment


class Topic(NamedTuple):
    """A topic that is there, as a bag is told of it."""

    name: str
    type_name: str
    qos: list  # what each publisher offers
    type_hash: str
    stamped: bool  # whether its messages begin with a stamp


class TopicChoice:
    """Finds the topics that are to be recorded, whenever they appear.

    Parameters
    ----------
    node : Node
    names : list of str
        Topics to wait for; empty texts are skipped.
    pattern : str
        Regular expression; empty for none. It finds topics in the recorder's namespace by their names in that, and
        never the recorder's own.

    Attributes
    ----------
    named : set
        Full names of the topics to wait for.
    """

    def __init__(self, node, names, pattern):
        self._node = node
        try:
            self.named = {node.resolve_topic_name(name) for name in names if name and validate_topic_name(name)}
        except InvalidTopicNameException as error:
            raise ParameterError(f"recorder: parameter 'topics' is {names!r}, accepted: names; {error}") from None
        try:
            self._pattern = re.compile(pattern) if pattern else None
        except re.error as error:
            raise ParameterError(
                f"recorder: parameter 'pattern' is {pattern!r}, accepted: regular expressions; {error}"
            ) from None
        if not self.named and self._pattern is None:
            raise ParameterError(
                "recorder: parameters 'topics' and 'pattern' are empty, at least one topic or a pattern is needed"
            )
        # rare and telling: who records what a law answers gets what changed of it along
        answers = node.resolve_topic_name(topics.COIL_CURRENT) in self.named
        self._along = {node.resolve_topic_name(topics.LAW_PARAMETERS)} if answers else set()
        own = topics.RECORDED, topics.RECORDED_ANSWERS, topics.RECORDED_TOPICS
        self._own = {node.resolve_topic_name(name) for name in own}

    def __str__(self):
        found = [f"topics matching '{self._pattern.pattern}'"] if self._pattern else []
        return ", ".join(sorted(self.named) + found)

    def present(self):
        """Return the names of all topics of the choice that have a publisher."""
        names = self.named | self._along
        if self._pattern:
            known = dict(self._node.get_topic_names_and_types()).keys() - self._own
            space = self._node.get_namespace().rstrip("/")
            inside = {name for name in known if name.startswith(f"{space}/")}
            names |= {name for name in inside if self._pattern.search(name.removeprefix(space))}
        return {name for name in names if self._node.get_publishers_info_by_topic(name)}

    def complete(self):
        """Return whether all named topics are there, and any at all."""
        present = self.present()
        return bool(present) and self.named <= present


def subscribe(node, name, on_message):
    """Subscribe to a topic that is there, taking all that every publisher can give.

    `on_message(topic, data)` gets each serialised message that is whole.

    Returns
    -------
    Topic, Subscription, or None
        None where whoever published has just gone.

    Raises
    ------
    ValueError
        Its type is not installed here.
    """
    infos = node.get_publishers_info_by_topic(name)
    if not infos:
        return None
    offers = [info.qos_profile for info in infos]
    qos = QoSProfile(depth=_DEPTH)
    if all(offer.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for offer in offers):
        qos.durability = QoSDurabilityPolicy.TRANSIENT_LOCAL
    if any(offer.reliability == QoSReliabilityPolicy.BEST_EFFORT for offer in offers):
        qos.reliability = QoSReliabilityPolicy.BEST_EFFORT
    type_name, type_hash = infos[0].topic_type, str(infos[0].topic_type_hash)
    kind = message_type(type_name)
    first_field = next(iter(kind.get_fields_and_field_types().values()), "")
    stamped = first_field in ("std_msgs/Header", "builtin_interfaces/Time")
    topic = Topic(name, type_name, [qos_record(offer) for offer in offers], type_hash, stamped)
    try:
        read = Checker(installed_definition(kind)).check
    except LayoutError:  # nobody reads it here, so it is recorded as it comes
        read = bytes
    return topic, node.listen(kind, name, lambda data: on_message(topic, data), qos, read)
