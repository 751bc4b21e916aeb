"""Parameters whose value or file is known when a description is visited."""

import yaml
from launch import LaunchError


class ParameterFile:
    """A parameter file."""

    def __init__(self, param_file, *, allow_substs=False):
        if allow_substs:
            raise LaunchError("this stand-in does not read parameter files with substitutions")
        self.param_file = param_file


class ParameterValue:
    """A value, of a type if one is given."""

    def __init__(self, value, *, value_type=None):
        self._value, self._type = value, value_type

    def evaluate(self, context):
        """Return the value."""
        return value_of(self._value, context) if self._type is None else self._typed(context)

    def _typed(self, context):
        if self._type is str:
            return context.perform_substitution(self._value)
        try:
            return self._type(value_of(self._value, context))
        except (TypeError, ValueError) as error:
            raise LaunchError(f"a parameter's value: {error}") from None


def value_of(value, context):
    """Return what a parameter's value in a launch file stands for: of substitutions what their text says in YAML."""
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if hasattr(value, "perform") or (isinstance(value, (list, tuple)) and any(hasattr(v, "perform") for v in value)):
        return yaml.safe_load(context.perform_substitution(value))
    return list(value) if isinstance(value, tuple) else value
