"""When an action is done."""

from launch.substitutions import truth


class IfCondition:
    """If an expression says true."""

    def __init__(self, predicate_expression):
        self._expression = predicate_expression

    def evaluate(self, context):
        """Return whether it does."""
        return truth(context.perform_substitution(self._expression))


class UnlessCondition(IfCondition):
    """If an expression says false."""

    def evaluate(self, context):
        """Return whether it does."""
        return not super().evaluate(context)


class LaunchConfigurationEquals:
    """If a launch argument has a value."""

    def __init__(self, launch_configuration_name, expected_value):
        self._name, self._expected = launch_configuration_name, expected_value

    def evaluate(self, context):
        """Return whether it has."""
        expected = None if self._expected is None else context.perform_substitution(self._expected)
        return context.launch_configurations.get(self._name) == expected
