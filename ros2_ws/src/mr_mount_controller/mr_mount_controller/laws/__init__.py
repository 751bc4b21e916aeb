"""Control laws: one per file, and the contract they fulfil (`ControlLaw`). No ROS."""

from functools import cache
from importlib import import_module
from importlib.metadata import entry_points

from ..node_base.parameters import Parameter, ParameterError
from ..node_base.suggestion import suggestion
from .base import ControlLaw, LawError, Sample
from .failures import FAILURES, reason_of

__all__ = ["ControlLaw", "LawError", "Parameter", "ParameterError", "Sample", "find_law", "known_laws", "shipped_laws"]

GROUP = "mr_mount_controller.laws"


def known_laws() -> list[str]:
    """Return the sorted names of the laws in all installed packages.

    Examples
    --------
    >>> from mr_mount_controller.laws import known_laws
    >>> "skyhook" in known_laws()
    True
    """
    return sorted(_installed())


def shipped_laws() -> list[str]:
    """Return the sorted names of the laws in this package, without those of users.

    Examples
    --------
    >>> from mr_mount_controller.laws import shipped_laws
    >>> len(shipped_laws())
    9
    """
    return sorted(name for name, place in _installed().items() if place.startswith(f"{__name__}."))


def find_law(name: str) -> type[ControlLaw]:
    """Return the class of a control law.

    Parameters
    ----------
    name : str
        A name from `known_laws`, or `package.module:Class`.

    Raises
    ------
    ParameterError
        There is no such law, or it is not a `ControlLaw`.

    Examples
    --------
    >>> from mr_mount_controller.laws import find_law
    >>> law = find_law("skyhook")(period=1e-3, firm_current=2.5)
    >>> law.firm_current  # A
    2.5
    """
    if name in _installed():
        return _load(name, _installed()[name])
    if not name.partition(":")[2]:
        raise ParameterError(
            f"parameter 'law' is {name!r}, must be one of {', '.join(known_laws())}, or package.module:Class"
            f"{suggestion(name, known_laws())}"
        )
    return _load(name, name)


@cache
def _installed():
    """Return places of laws by their names: installed packages are looked through once in a process."""
    places = {}
    for entry in entry_points(group=GROUP):
        places.setdefault(entry.name, entry.value)
    return places


def _load(name, place):
    module, _, attribute = place.partition(":")
    loaded = None
    try:
        loaded = import_module(module)
        law = getattr(loaded, attribute)
    except FAILURES as error:  # whatever the module of a user raises
        hint = "; is its folder on PYTHONPATH?" if isinstance(error, ModuleNotFoundError) else ""
        meant = suggestion(attribute, [key for key, value in vars(loaded).items() if _is_law(value)]) if loaded else ""
        reason = f"{reason_of(error)}{hint}{meant}"
        raise ParameterError(f"parameter 'law' is {name!r}, which cannot be loaded: {reason}") from error
    if not _is_law(law):
        raise ParameterError(f"parameter 'law' is {name!r}, which is not a subclass of {ControlLaw.__name__}")
    return law


def _is_law(value):
    return isinstance(value, type) and issubclass(value, ControlLaw) and value is not ControlLaw
