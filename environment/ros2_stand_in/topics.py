"""`ros2 topic list` and `info`."""

from environment.ros2_stand_in.session import Session, absolute, shown
from environment.ros2_stand_in.terminal import Failure, line, lines


def list_topics(chosen):
    """Print names, types or counts."""
    with Session() as session:
        session.settle(chosen.spin_time)
        found = shown(session.node.get_topic_names_and_types(), chosen.include_hidden_topics)
        if chosen.count_topics:
            line(len(found))
        elif chosen.verbose:
            _by_ends(session.node, found)
        else:
            for name, types in found:
                line(f"{name} [{types}]" if chosen.show_types else name)


def _by_ends(node, found):
    for title, word, count in (
        ("Published topics:", "publisher", node.count_publishers),
        ("Subscribed topics:", "subscriber", node.count_subscribers),
    ):
        line(title)
        for name, types in found:
            if number := count(name):
                line(f" * {name} [{types}] {number} {word}{'s' if number > 1 else ''}")
        line()


def info(chosen):
    """Print type and counts, with --verbose each end."""
    with Session() as session:
        node, topic = session.node, absolute(chosen.topic_name)
        types = session.find_topic(topic, chosen.spin_time)
        if not types:
            raise Failure(f"Unknown topic '{topic}'")
        gap = "\n" if chosen.verbose else ""
        lines(f"Type: {types[0] if len(types) == 1 else types}{gap}")
        for title, count, ends in (
            ("Publisher count", node.count_publishers, node.get_publishers_info_by_topic),
            ("Subscription count", node.count_subscribers, node.get_subscriptions_info_by_topic),
        ):
            lines(f"{title}: {count(topic)}{gap}")
            for end in ends(topic) if chosen.verbose else ():
                lines(f"{end}\n")
