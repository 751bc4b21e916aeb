"""Who is in the ROS graph: the nodes at the ends of a topic, by their full names."""

_UNKNOWN = "_NODE_NAME_UNKNOWN_"  # rmw's word for it


def publishing_nodes(node, topic_names):
    """Return the full names of all nodes that publish on some topics, sorted."""
    return sorted({full_name(info) for name in topic_names for info in node.get_publishers_info_by_topic(name)})


def subscribing_nodes(node, topic_name):
    """Return the full names of all nodes that subscribe to a topic, sorted."""
    return sorted({full_name(info) for info in node.get_subscriptions_info_by_topic(topic_name)})


def full_name(endpoint):
    """Return the name, with its namespace, of the node that a publisher or subscription of the graph belongs to."""
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"


def is_known(name):
    """Return whether a node's name has arrived: it comes a moment after the node's publishers and subscriptions."""
    return _UNKNOWN not in name
