"""`ros2 topic echo`: prints messages as they come."""

import sys

from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.definitions import installed_definition
from mr_mount_controller.node_base.listener import Listener, whole_message
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.serialization import deserialize_message

from environment.ros2_stand_in.message_text import part_of, plain, to_csv, to_yaml
from environment.ros2_stand_in.session import Session, absolute, interface
from environment.ros2_stand_in.terminal import Failure, line, lines

_DEPTH = 10


def echo(chosen):
    """Print until interrupted, or the first message only."""
    topic, printed = absolute(chosen.topic_name), []
    with Session() as session:
        kind = _message_type(session, topic, chosen)
        try:
            installed_definition(kind)
            read = whole_message(kind)
        except LayoutError:  # not checked before it is read, as the checker does not know its layout
            read = lambda data: deserialize_message(data, kind)  # noqa: E731
        failures = []

        def on_message(message):
            if failures or (chosen.once and printed):
                return
            try:
                _print(message, chosen)
            except Failure as failure:  # raised later: what leaves a callback is logged at length
                failures.append(failure)
            printed.append(True)

        Listener(session.node, kind, topic, on_message, _qos(session.node, topic, chosen), read)
        try:
            session.wait_until(lambda: failures or (chosen.once and printed), chosen.timeout)
        except KeyboardInterrupt:
            if chosen.once:
                raise
        if failures:
            raise failures[0]


def _message_type(session, topic, chosen):
    if chosen.message_type:
        return interface(chosen.message_type, "msg")
    types = session.find_topic(topic, chosen.spin_time)
    if not types:
        line(f"WARNING: topic [{topic}] does not appear to be published yet", sys.stderr)
        raise Failure("Could not determine the type for the passed topic")
    if len(types) > 1:
        raise Failure(f"topic {topic} has several types: {', '.join(types)}; give the one to print")
    return interface(types[0], "msg")


def _qos(node, topic, chosen):
    """What every publisher that is there can give, but for what the user asks for."""
    offers = [each.qos_profile for each in node.get_publishers_info_by_topic(topic)]
    reliable = all(each.reliability == QoSReliabilityPolicy.RELIABLE for each in offers)
    kept = bool(offers) and all(each.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for each in offers)
    reliability = chosen.qos_reliability or ("reliable" if reliable else "best_effort")
    durability = chosen.qos_durability or ("transient_local" if kept else "volatile")
    return QoSProfile(
        depth=chosen.qos_depth or _DEPTH,
        reliability=QoSReliabilityPolicy[reliability.upper()],
        durability=QoSDurabilityPolicy[durability.upper()],
    )


def _print(message, chosen):
    part = part_of(message, chosen.field) if chosen.field else message
    longest = None if chosen.full_length else chosen.truncate_length
    value = plain(part, longest, chosen.no_arr, chosen.no_str)
    if chosen.csv:
        line(to_csv(value))
    elif isinstance(value, (dict, list)):
        lines(f"{to_yaml(value, chosen.flow_style)}---")
    else:
        line(value)
        line("---")
