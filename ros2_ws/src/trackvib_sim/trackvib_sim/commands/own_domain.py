"""A ROS domain, or a namespace in it, held for one run."""

import os
import socket
from contextlib import contextmanager
from hashlib import sha256

from .result_folder import CommandError

HIGHEST_DOMAIN = 232  # of ROS 2; beyond it DDS has no ports


@contextmanager
def own_domain(namespace="/"):
    """Hold a namespace of the ROS domain against further runs; raise `CommandError` if it is impossible or taken."""
    from ..nodes.watch import Watch  # imported late: ROS 2 comes after the processes have been made

    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not (domain.isdecimal() and int(domain) <= HIGHEST_DOMAIN):
        raise CommandError(f"ROS_DOMAIN_ID is {domain!r}, accepted: a whole number from 0 to {HIGHEST_DOMAIN}")
    where = f"in ROS domain {domain}" + ("" if namespace == "/" else f" and namespace {namespace}")
    taken = CommandError(f"a simulator is already running {where}; set another ROS_DOMAIN_ID or --namespace")
    # a name that the kernel frees with the process, however that ends; it takes no long ones
    claimed = sha256(namespace.encode()).hexdigest()[:16]
    with socket.socket(socket.AF_UNIX) as claim:
        try:
            claim.bind(f"\0trackvib_run_in_domain_{int(domain)}_{claimed}")
        except OSError:
            raise taken from None
        # a simulator that was started by hand is seen if it makes itself known in time
        with Watch(namespace) as watch:
            if watch.simulator_is_there():
                raise taken
        yield
