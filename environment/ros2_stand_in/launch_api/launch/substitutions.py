"""Texts that are known when a description is visited."""

import os

from launch import LaunchError


class Substitution:
    """Something that stands for a text."""

    def perform(self, context):
        """Return the text."""
        raise NotImplementedError


class TextSubstitution(Substitution):
    """The text itself."""

    def __init__(self, *, text):
        self.text = text

    def perform(self, context):
        """Return it."""
        return self.text


class LaunchConfiguration(Substitution):
    """The value of a launch argument."""

    def __init__(self, variable_name, *, default=None):
        self.variable_name, self.default = variable_name, default

    def perform(self, context):
        """Return the value."""
        name = context.perform_substitution(self.variable_name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]
        if self.default is None:
            raise LaunchError(f"launch configuration '{name}' does not exist")
        return context.perform_substitution(self.default)


class EnvironmentVariable(Substitution):
    """The value of a variable of the environment."""

    def __init__(self, name, *, default_value=None):
        self.name, self.default_value = name, default_value

    def perform(self, context):
        """Return the value."""
        name = context.perform_substitution(self.name)
        variables = {**os.environ, **context.environment}
        if name in variables:
            return variables[name]
        if self.default_value is None:
            raise LaunchError(f"environment variable '{name}' does not exist")
        return context.perform_substitution(self.default_value)


class PathJoinSubstitution(Substitution):
    """Parts of a path, joined."""

    def __init__(self, substitutions):
        self.substitutions = substitutions

    def perform(self, context):
        """Return the path."""
        return os.path.join(*map(context.perform_substitution, self.substitutions))


def truth(text):
    """Return whether a text says true; raises `LaunchError` if it says neither."""
    words = {"true": True, "1": True, "false": False, "0": False}
    if (word := text.strip().lower()) not in words:
        raise LaunchError(f"a condition is {text!r}, accepted: one of {', '.join(words)}")
    return words[word]
