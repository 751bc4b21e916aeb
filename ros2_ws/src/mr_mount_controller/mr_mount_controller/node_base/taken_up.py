"""When a new client may ask without losing the response."""


def taken_up(node):
    """Return a condition that holds once the node's executor, spun meanwhile, has taken up all the node has now.

    Wait for it before the first request of a client. An executor of events counts what has come already and then asks
    to be told of more; Fast DDS never tells of a response that comes between the two.
    """
    return node.executor.create_task(lambda: None).done  # the executor works off both in the order of their coming
