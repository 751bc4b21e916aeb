"""What whoever runs a law does with it; all that the law's own code raises comes out as one sentence."""

from contextlib import contextmanager
from math import isfinite

import numpy as np

from ..node_base.parameters import ParameterError
from ..node_base.plain_text import plain_line, shortened
from .base import LawError
from .failures import FAILURES, place_of, reason_of

_LONGEST = 1000  # characters of an answer that is no current


def make_law(kind, period, values):
    """Return a law of a class for a sampling period [s], with values of its parameters by name.

    Raises
    ------
    ParameterError
        The values do not go together, or the law cannot be made with them.
    """
    try:
        return kind(period, **values)
    except ParameterError:
        raise
    except FAILURES as error:
        raise ParameterError(f"law {kind.__name__} cannot be made: {reason_of(error, kind)}") from error


def changed_law(law, values):
    """Return a law that goes on for another one with other values of some parameters, by name.

    Raises
    ------
    ParameterError
        They do not go together, or the law cannot be made with them.
    """
    kept = {parameter.name: getattr(law, parameter.name) for parameter in law.parameters}
    try:
        changed = type(law)(law.period, **{**kept, **values})
        changed.run_on(law.mounting)
        changed.continue_from(law)
    except ParameterError:
        raise
    except FAILURES as error:  # must not end a run that goes well
        reason = reason_of(error, type(law))
        raise ParameterError(f"law {type(law).__name__} cannot take {values}: {reason}") from error
    return changed


@contextmanager
def law_code(law, what):
    """Run a law's own code, which does `what`; raise `LawError` for whatever it raises."""
    try:
        yield
    except FAILURES as error:
        raise LawError(f"law {type(law).__name__} failed {what}: {reason_of(error, type(law))}") from error


def run_law_on(law, mounting):
    """Restart a law on the mounts of a `mounting.Mounting`; raises `LawError`."""
    with law_code(law, "at its start"):
        law.run_on(mounting)


def answer(law, sample):
    """Return the law's currents, one per coil [A], for a sample.

    Raises
    ------
    LawError
        The law raised an exception, or returned something else than one finite number, or one for each coil.
    """
    coils = law.mounting.coils
    try:
        result = law.update(sample)
    except FAILURES as error:
        name = type(law).__name__
        raise LawError(f"law {name} failed at t = {sample.time:.3f} s: {reason_of(error, type(law))}") from error
    if type(result) is float and isfinite(result):  # what most laws answer, every period
        return np.full(coils, result)
    try:
        numbers = np.asarray(result)
        # digits in a text and truth values are no currents, though numpy would make numbers of them
        numbers = numbers.astype(float) if numbers.dtype.kind in "fiu" else np.full(1, np.nan)
        currents = np.broadcast_to(numbers, (coils,))
    except FAILURES:
        numbers = np.full(1, np.nan)
    if not np.isfinite(numbers).all():
        raise LawError(
            f"law {type(law).__name__} answered {_shown(result)} at t = {sample.time:.3f} s{place_of(law.update)}, "
            f"must be one finite current [A], or {coils} of them, one per coil"
        )
    return currents


def _shown(result):
    """Return an answer that is no current as one line of signs."""
    try:
        return shortened(plain_line(repr(result)), _LONGEST)
    except FAILURES:
        return f"a {type(result).__name__}"
