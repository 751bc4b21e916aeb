"""A ROS domain, or a namespace in it, held for one run, and a look for who is in it already."""

import multiprocessing
import os
import socket
from contextlib import contextmanager
from hashlib import sha256

from ..nodes.forked_node import begin_program, fork
from .result_folder import CommandError

HIGHEST_DOMAIN = 232  # of ROS 2; beyond it DDS has no ports


class Lookout:
    """Looks in a process of its own whether a simulator runs already, while this one loads what a run needs."""

    def __init__(self, namespace="/"):
        self.namespace = namespace
        self._found, there = multiprocessing.Pipe(duplex=False)
        fork(_look, namespace, there)
        there.close()

    def simulator_is_there(self):
        """Return what it has found, as soon as it has."""
        try:
            return self._found.recv()
        except EOFError:  # it has ended without a word: what is wrong shows here
            return _simulator_is_there(self.namespace)


def _look(namespace, found):
    begin_program("lookout")
    silence = os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):
        os.dup2(silence, number)
    found.send(_simulator_is_there(namespace))


def _simulator_is_there(namespace):
    from ..nodes.watch import Watch  # imported late: in the process that looks, as a rule

    with Watch(namespace) as watch:
        return watch.simulator_is_there()


@contextmanager
def own_domain(lookout):
    """Hold the namespace of a `Lookout` against further runs; raise `CommandError` if it is impossible or taken."""
    namespace = lookout.namespace
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
        if lookout.simulator_is_there():
            raise taken
        yield
