"""Cases on many cores at once, by Dask: those of this machine, or a cluster that is there already."""

import logging
import signal
from contextlib import contextmanager
from multiprocessing import resource_tracker

from dask.system import CPU_COUNT
from distributed import Client, KilledWorker, LocalCluster, as_completed

from .case_store import program
from .drive import drive

PATIENCE = 5.0  # s for a cluster to answer
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class FarmError(RuntimeError):
    """No workers, or workers that cannot do it; the message says why."""


@contextmanager
def farm(scheduler, cases):
    """Give a Dask `Client`: of the scheduler at an address, or, if that is None, of one process a core of this machine.

    Raises
    ------
    FarmError
        Nothing answers at the address, or workers that have no trackvib, or another version of it.
    """
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # the caller says what is to be said
    if scheduler is None:
        with _local(min(CPU_COUNT, cases)) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=PATIENCE)
    except (OSError, ValueError):
        raise FarmError(f"no Dask scheduler answers at {scheduler!r} within {PATIENCE:g} s") from None
    with client:
        _check_workers(client, scheduler)
        yield client


def results(client, vehicle, cases):
    """Yield each case with its `drive.Result`, in the order in which workers finish them.

    Cases of a worker that dies are done again by another one.

    Raises
    ------
    FarmError
        The cluster is gone, or every worker that takes up a case dies.
    NoEquilibrium
        The vehicle cannot stand.
    """
    futures = client.map(drive, [vehicle] * len(cases), cases, pure=False)
    case_of = dict(zip(futures, cases, strict=True))
    for future in as_completed(futures):
        try:
            yield case_of[future], future.result()
        except KilledWorker as error:
            raise FarmError(f"{case_of[future]}: {error}") from None


def _local(workers):
    """Start a cluster whose processes leave signals to this one, which then ends them."""
    # the tracker would let signals through again when it starts
    resource_tracker.ensure_running()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
    try:
        return LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            memory_limit=None,
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        )
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _check_workers(client, scheduler):
    try:
        client.wait_for_workers(1, PATIENCE)
    except TimeoutError:
        raise FarmError(f"the Dask scheduler at {scheduler!r} has no workers") from None
    here = program()
    for worker, there in client.run(program, on_error="return").items():
        if isinstance(there, Exception):
            raise FarmError(f"worker {worker} of {scheduler!r} cannot load trackvib: {there}")
        if there != here:
            raise FarmError(f"worker {worker} of {scheduler!r} has another version of trackvib")
