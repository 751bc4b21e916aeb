"""Whether the nodes of this container answer; its health check. Other verbs than nodes are healthy while they run."""

import sys
import time
from pathlib import Path

import rclpy
from rcl_interfaces.srv import ListParameters

NODES = {name: name for name in ("simulator", "road_excitation", "controller", "recorder", "player")}
NODES["one_process"] = "simulator"  # a program, and a node that runs in it
PATIENCE = 12.0  # s, well below the time that the engine gives


def nodes_here():
    """Names of the nodes whose programs run in this container."""
    programs = set()
    for name in Path("/proc").glob("[0-9]*/comm"):
        try:
            programs.add(name.read_text().strip())
        except OSError:  # it has ended
            continue
    return {NODES[program] for program in programs & NODES.keys()}


def silent(names):
    """Those of `names` of which no node, in whatever namespace, answers when it is asked for its parameters.

    Who ends meanwhile need not.
    """
    rclpy.init()
    asking = rclpy.create_node("health", start_parameter_services=False, enable_rosout=False)
    end = time.monotonic() + PATIENCE
    left, futures = set(names), {}
    while left and time.monotonic() < end:
        for name, namespace in asking.get_node_names_and_namespaces():
            service = f"{namespace.rstrip('/')}/{name}/list_parameters"
            if name in left and service not in futures:
                client = asking.create_client(ListParameters, service)
                if client.wait_for_service(1.0):
                    futures[service] = client.call_async(ListParameters.Request())
        rclpy.spin_once(asking, timeout_sec=0.1)
        left -= {service.split("/")[-2] for service, future in futures.items() if future.done()}
    rclpy.shutdown()
    return sorted(left & nodes_here())


if __name__ == "__main__":
    dumb = silent(nodes_here())
    if dumb:
        sys.exit(f"no answer from: {', '.join(dumb)}")
