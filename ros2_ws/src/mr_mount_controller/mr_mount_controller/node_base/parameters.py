"""What a parameter is: one description, from which nodes, command line and documents take name, unit and range."""

from dataclasses import dataclass
from math import isfinite

from .plain_text import span

_WHOLE = 1 << 53  # up to which floating-point numbers hold every whole number


class ParameterError(ValueError):
    """A parameter that cannot be used; the message names it, its value and what is accepted.

    Examples
    --------
    >>> from mr_mount_controller.laws import Parameter
    >>> Parameter("gain", 1.0, "Of the law.", "A s/m", 0.0, 10.0).check(20.0)
    Traceback (most recent call last):
    mr_mount_controller.node_base.parameters.ParameterError: parameter 'gain' is 20.0, ...
    """


@dataclass(frozen=True)
class Parameter:
    """A named value of the type of its default; a whole number is valid for any number.

    Numbers lie in [low, high]; strings, where `choices` is given, are one of them.

    Examples
    --------
    >>> from mr_mount_controller.laws import Parameter
    >>> Parameter("firm_current", 2.5, "Current of a firm mount.", "A", 0.7, 4.0).check(3.0)
    3.0
    """

    name: str
    default: bool | int | float | str | list
    description: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple = ()

    @property
    def accepted(self):
        """What is accepted, in words."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        kind = {
            bool: "true or false",
            int: "a whole number",
            float: "a number",
            str: "a text",
            list: "a list of strings (none: [''])",
        }
        words = kind[type(self.default)]
        if self.low is not None:
            return f"{words} from {span(self.low, self.high, self.unit)}"
        return f"{words} {self.unit}".rstrip()

    def check(self, value):
        """Return `value` if it is acceptable, of the type of the default.

        Raises
        ------
        ParameterError
            It is not.
        """
        value = self.converted(value)
        good = type(value) is type(self.default)
        if good and self.choices:
            good = value in self.choices
        if good and isinstance(value, float):
            good = isfinite(value)
        if good and isinstance(value, list):
            good = all(type(each) is str for each in value)
        if good and self.low is not None:
            good = self.low <= value <= self.high
        if not good:
            raise ParameterError(f"parameter '{self.name}' is {value!r}, accepted: {self.accepted}")
        return value

    def converted(self, value):
        """Return a whole number as a floating-point number where the default is one, all else unchanged."""
        if isinstance(self.default, float) and type(value) is int and abs(value) <= _WHOLE:
            return float(value)
        return value
