"""Run-ins that are kept: each is done once, for all runs of one vehicle that begin alike.

They lie in the folder `run_in` beside the compiled kernels (NUMBA_CACHE_DIR), which goes with every change of the
sources; without such a folder none is kept.
"""

from contextlib import suppress
from hashlib import sha256
from os import environ
from pathlib import Path
from tempfile import NamedTemporaryFile

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_features, get_host_cpu_name

from . import run_in as fresh

MOST = 200  # that are kept, of some 100 KB each; the oldest make room


def run_in(vehicle, system, settings):
    """Return what `run_in.run_in` does, to the last bit, and raise as it does."""
    if "NUMBA_CACHE_DIR" not in environ:
        return fresh.run_in(vehicle, system, settings)
    folder = Path(environ["NUMBA_CACHE_DIR"]) / "run_in"
    file = folder / _key(vehicle, system, settings)
    state = fresh.new_state(system)
    with suppress(OSError):
        if _filled(state, file.read_bytes()):
            return state
    state = fresh.run_in(vehicle, system, settings)
    with suppress(OSError):  # a full disk, or one that may not be written
        _keep(file, b"".join(leaf.tobytes() for leaf in _leaves(state)))
    return state


def _key(vehicle, system, settings):
    """Name what a run-in depends on: the vehicle, how it is driven, and the processor, on which its bits depend."""
    digest = sha256(vehicle.model_dump_json().encode())
    for leaf in _leaves(system):
        digest.update(leaf.tobytes() if isinstance(leaf, np.ndarray) else repr(leaf).encode())
    target = numba.config.CPU_NAME, get_host_cpu_name(), get_host_cpu_features().flatten()
    told = (settings.operation.track_phase, settings.passive_current, fresh.DURATION)
    digest.update(repr((*told, *target)).encode())
    return digest.hexdigest()


def _leaves(record):
    if isinstance(record, tuple):
        for part in record:
            yield from _leaves(part)
    else:
        yield record


def _filled(state, data):
    """Fill a state with what was kept; returns whether that is whole."""
    leaves, place = list(_leaves(state)), sha256().digest_size
    whole = len(data) == place + sum(leaf.nbytes for leaf in leaves)
    if not whole or sha256(data[place:]).digest() != data[:place]:
        return False
    for leaf in leaves:
        leaf[...] = np.frombuffer(data, leaf.dtype, leaf.size, place).reshape(leaf.shape)
        place += leaf.nbytes
    return True


def _keep(file, data):
    """Write a file that is there as a whole or not at all, whoever else writes it as well."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with NamedTemporaryFile(dir=file.parent, prefix=".", delete=False) as draft:
        draft.write(sha256(data).digest() + data)
    Path(draft.name).replace(file)
    kept = sorted(file.parent.glob("[!.]*"), key=lambda each: each.stat().st_mtime)
    for old in kept[:-MOST]:
        old.unlink(missing_ok=True)
