"""`ros2 node list` and `info`."""

import sys

from rclpy.node import NodeNameNonExistentError

from environment.ros2_stand_in.session import Session, is_hidden
from environment.ros2_stand_in.terminal import Failure, line

_GOAL = "/_action/send_goal"


def list_nodes(chosen):
    """Print names, or their number."""
    with Session() as session:
        session.settle(chosen.spin_time)
        names = [name for name in session.node_names() if chosen.all or not is_hidden(name)]
    if chosen.count_nodes:
        line(len(names))
        return
    if len(set(names)) < len(names):
        line("WARNING: Be aware that there are nodes in the graph that share an exact name, "
             "which can have unintended side effects.", sys.stderr)  # fmt: skip
    for name in names:
        line(name)


def info(chosen):
    """Print what a node publishes, hears, offers and calls."""
    with Session() as session:
        session.settle(chosen.spin_time)
        count = session.node_names().count(chosen.node_name)
        if not count:
            raise Failure(f"Unable to find node '{chosen.node_name}'")
        if count > 1:
            line(f"There are {count} nodes in the graph with the exact name \"{chosen.node_name}\". "
                 "You are seeing information about only one of them.", sys.stderr)  # fmt: skip
        space, _, name = chosen.node_name.rpartition("/")
        try:
            ask = [
                list(asked(name, space or "/"))
                for asked in (
                    session.node.get_subscriber_names_and_types_by_node,
                    session.node.get_publisher_names_and_types_by_node,
                    session.node.get_service_names_and_types_by_node,
                    session.node.get_client_names_and_types_by_node,
                )
            ]
        except NodeNameNonExistentError:  # it has just gone
            raise Failure(f"Unable to find node '{chosen.node_name}'") from None
    line(chosen.node_name)
    for title, found in zip(("Subscribers", "Publishers", "Service Servers", "Service Clients"), ask, strict=True):
        _print(title, [each for each in found if chosen.include_hidden or not is_hidden(each[0])])
    # an action is known by the service that takes goals, on the side that offers it and on the one that calls
    _print("Action Servers", _actions(ask[2]))
    _print("Action Clients", _actions(ask[3]))


def _actions(services):
    return [
        (name.removesuffix(_GOAL), [each.removesuffix("_SendGoal") for each in types])
        for name, types in services
        if name.endswith(_GOAL)
    ]


def _print(title, found):
    line(f"  {title}:")
    for name, types in sorted(found):
        line(f"    {name}: {', '.join(types)}")
    if not found:
        line()
