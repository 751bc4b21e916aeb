"""`ros2 service list` and `call`."""

import os
import time

os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"  # of messages that are imported from here on: a wrong value is an error

from environment.ros2_stand_in.message_text import fill, from_yaml  # noqa: E402
from environment.ros2_stand_in.session import Session, absolute, interface, shown  # noqa: E402
from environment.ros2_stand_in.terminal import line, lines  # noqa: E402


def list_services(chosen):
    """Print names, types or their number."""
    with Session() as session:
        session.settle(chosen.spin_time)
        found = shown(session.node.get_service_names_and_types(), chosen.include_hidden_services)
    if chosen.count_services:
        line(len(found))
        return
    for name, types in found:
        line(f"{name} [{types}]" if chosen.show_types else name)


def call(chosen):
    """Call a service once, or at a rate until interrupted, and print its response."""
    kind = interface(chosen.service_type, "srv")
    request = kind.Request()
    fill(request, from_yaml(chosen.values, "the request") or {})
    with Session() as session:
        client = session.node.create_client(kind, absolute(chosen.service_name))
        if not client.service_is_ready():
            line("waiting for service to become available...")
            session.wait_until(client.service_is_ready)
        while True:
            lines(f"requester: making request: {request!r}\n")
            began = time.monotonic()
            future = client.call_async(request)
            session.wait_until(future.done)
            lines(f"response:\n{future.result()!r}\n")
            if chosen.rate is None:
                return
            session.wait_until(lambda: time.monotonic() - began > 1.0 / chosen.rate)  # noqa: B023
