"""Cases on many cores at once, by Dask: those of this machine, or a cluster that is there already."""

import asyncio
import logging
import os
from contextlib import ExitStack, contextmanager
from itertools import islice
from multiprocessing import resource_tracker
from queue import Empty, SimpleQueue

import dask
from dask.system import CPU_COUNT
from distributed import CancelledError, Client, KilledWorker, LocalCluster, Security, TimeoutError, rpc
from distributed.utils import get_mp_context
from mr_mount_controller.node_base.interrupts import block_interrupts

from .case import drive
from .case_store import program

PATIENCE = 5.0  # s for a cluster to answer
AHEAD, LEAST_AHEAD = 4, 100  # tasks a thread, and at least, that are handed out before they are due
LONG_PATIENCE = 30.0  # s for a worker that died to be started again
_NOISY = ("distributed", "distributed.client", "tornado.application", "tornado.general")
# scheduler and workers always have an HTTP server; without routes it has nothing to tell
_NO_PAGES = {"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []}
# nor does anybody look at profiles of workers, which take a twentieth of a case
_NO_PROFILES = {"distributed.worker.profile.enabled": False}
# nor need a worker hand the memory of each array back, to ask for it anew for the next one, as it does by default: the
# filters of a case take half as long again by that; bytes, of arrays and of what is free at the end of a heap
_KEPT_MEMORY = {f"distributed.nanny.pre-spawn-environ.MALLOC_{name}_THRESHOLD_": 2**25 for name in ("MMAP", "TRIM")}
# workers are forked from a process that has loaded once what all of them need
_FORKED = {"distributed.worker.multiprocessing-method": "forkserver"}


class WorkersError(RuntimeError):
    """No workers, or workers that cannot do it; the message says why."""


@contextmanager
def workers(scheduler, cases):
    """Give a Dask `Client`: of the scheduler at an address, or, if that is None, of one process a core of this machine.

    Of `SharedWorkers` it is theirs, which lasts.

    Raises
    ------
    WorkersError
        Nothing answers at the address, or workers that have no trackvib, or another version of it.
    """
    if isinstance(scheduler, SharedWorkers):
        yield scheduler.client()
        return
    for name in _NOISY:
        logging.getLogger(name).setLevel(logging.CRITICAL)  # an error that matters here is raised
    if scheduler is None:
        with _local(min(CPU_COUNT, cases)) as cluster, Client(cluster) as client:
            yield client
        return
    _check_scheduler(scheduler)
    with Client(scheduler, timeout=PATIENCE) as client:
        _check_workers(client, scheduler)
        yield client


class SharedWorkers:
    """Workers for several parts of a study: begun for the first that needs them, they end with this context.

    They are given where an address is wanted; `scheduler` and `cases`, the most that there can be, are as `workers`
    takes them.
    """

    def __init__(self, scheduler, cases):
        self._scheduler, self._cases = scheduler, cases
        self._begun, self._client = ExitStack(), None

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return self._begun.__exit__(*error)

    def client(self):
        """Return their `Client`; raises as `workers`."""
        if self._client is None:
            self._client = self._begun.enter_context(workers(self._scheduler, self._cases))
        return self._client


def results(client, vehicle, cases, run=drive):
    """Yield each case with `run(vehicle, case)`, in the order in which workers finish them; raises as `finished`."""
    for k, result in finished(client, run, [(vehicle, case) for case in cases]):
        yield cases[k], result


def finished(client, function, tasks):
    """Yield the number of each task with `function(*task)`, in the order in which workers finish them.

    Tasks of a worker that dies are done again by another one.

    Raises
    ------
    WorkersError
        Scheduler or workers are gone, or cannot do it.
    """
    waiting, number = iter(enumerate(tasks)), {}  # the latter of each future that is not done
    done = SimpleQueue()  # `wait` for the first of many would wait for each of them anew every time
    # thousands handed out at once would cost more than they take
    most = max(LEAST_AHEAD, AHEAD * sum(client.nthreads().values()))
    try:
        while True:
            for k, task in islice(waiting, most - len(number)):
                future = client.submit(function, *task, pure=False)
                number[future] = k
                future.add_done_callback(done.put)
            if not number:
                return
            future = _next(client, done)
            yield number.pop(future), future.result()
    except CancelledError:
        raise WorkersError("the connection to the Dask scheduler is lost") from None
    except KilledWorker as error:
        raise WorkersError(f"workers die while running a case: {error}") from None
    except ImportError as error:
        raise WorkersError(f"a worker cannot load trackvib: {error}") from None


def _next(client, done):
    """Wait until another future is done; returns it."""
    while True:
        try:
            return done.get(timeout=PATIENCE)
        except Empty:
            if not client.nthreads():
                _wait_for_worker(client, LONG_PATIENCE)


def _wait_for_worker(client, patience):
    try:
        client.wait_for_workers(1, patience)
    except TimeoutError:
        raise WorkersError(f"the Dask scheduler has had no worker for {patience:g} s") from None


def _local(workers):
    """Start a cluster that takes nothing but from itself, whose processes leave signals to this one, which ends them.

    Its credentials are made for it alone; its processes get them through pipes.
    """
    # before anything of ours runs in them, they would look for modules where the user stands (not from Python 3.11 on)
    os.environ["PYTHONSAFEPATH"] = "1"
    # the tracker would let signals through again when it starts
    resource_tracker.ensure_running()
    with block_interrupts(), dask.config.set(_NO_PAGES | _NO_PROFILES | _KEPT_MEMORY | _FORKED):
        get_mp_context().set_forkserver_preload(["distributed", "trackvib_sim.studies.case"])
        return LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            memory_limit=None,
            security=Security.temporary(),
            dashboard_address=None,
            scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},  # where its HTTP server is: any free port
            silence_logs=logging.CRITICAL,
        )


def _check_scheduler(address):
    """Ask who is there; a `Client` would wait for ever on a server that speaks another protocol."""

    try:
        credentials = Security().get_connection_args("client")  # of Dask's configuration, as a `Client` takes them
    except OSError as error:
        raise WorkersError(f"the TLS credentials in Dask's configuration cannot be used: {error}") from None

    async def kind():
        async with rpc(address, connection_args=credentials) as server:
            return (await server.identity())["type"]

    try:
        found = asyncio.run(asyncio.wait_for(kind(), PATIENCE))
    except Exception:  # a foreign server's answer can be anything
        found = None
    if found != "Scheduler":
        raise WorkersError(f"no Dask scheduler answers at {address!r} within {PATIENCE:g} s; use e.g. tcp://host:8786")


def _check_workers(client, scheduler):
    _wait_for_worker(client, PATIENCE)
    here = program()
    for worker, there in client.run(program, on_error="return").items():
        if isinstance(there, Exception):
            raise WorkersError(f"worker {worker} of {scheduler!r} cannot load trackvib: {there}")
        if there != here:
            raise WorkersError(f"worker {worker} of {scheduler!r} has another version of trackvib")
