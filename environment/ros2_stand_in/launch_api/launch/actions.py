"""What a launch description does."""

from launch import LaunchDescription, LaunchDescriptionEntity, LaunchError
from launch.launch_description_sources import PythonLaunchDescriptionSource


class Action(LaunchDescriptionEntity):
    """Something that is done, if its condition holds."""

    def __init__(self, *, condition=None):
        self.condition = condition

    def visit(self, context):
        """Do it."""
        if self.condition is None or self.condition.evaluate(context):
            self.execute(context)

    def execute(self, context):
        """Do it whatever the condition."""
        raise NotImplementedError


class DeclareLaunchArgument(Action):
    """An argument of the file, with its default."""

    def __init__(self, name, *, default_value=None, description=None, choices=None, **kwargs):
        super().__init__(**kwargs)
        self.name, self.default_value, self.description, self.choices = name, default_value, description, choices

    def default_text(self):
        """Return the default as people read it."""
        return self.default_value if isinstance(self.default_value, str) else repr(self.default_value)

    def execute(self, context):
        """Take the default where no value is given; raise `LaunchError` if there is none, or not that one."""
        values = context.launch_configurations
        if self.name not in values:
            if self.default_value is None:
                raise LaunchError(f"required launch argument '{self.name}' was not provided: {self.description or ''}")
            values[self.name] = context.perform_substitution(self.default_value)
        if self.choices and values[self.name] not in self.choices:
            raise LaunchError(
                f"launch argument '{self.name}' is {values[self.name]!r}, accepted: one of {', '.join(self.choices)}"
            )


class SetLaunchConfiguration(Action):
    """Gives an argument a value."""

    def __init__(self, name, value, **kwargs):
        super().__init__(**kwargs)
        self._name, self._value = name, value

    def execute(self, context):
        """Give it."""
        name = context.perform_substitution(self._name)
        context.launch_configurations[name] = context.perform_substitution(self._value)


class SetEnvironmentVariable(Action):
    """Gives processes that follow a variable."""

    def __init__(self, name, value, **kwargs):
        super().__init__(**kwargs)
        self._name, self._value = name, value

    def execute(self, context):
        """Note it for them."""
        context.environment[context.perform_substitution(self._name)] = context.perform_substitution(self._value)


class GroupAction(Action):
    """Actions of which nothing but their processes is left behind."""

    def __init__(self, actions, *, scoped=True, **kwargs):
        super().__init__(**kwargs)
        self._actions, self._scoped = list(actions), scoped

    def execute(self, context):
        """Do them."""
        kept = context.launch_configurations, context.namespace, context.parameters, context.environment
        if self._scoped:
            context.launch_configurations, context.environment = dict(kept[0]), dict(kept[3])
            context.parameters = list(kept[2])
        context.visit(self._actions)
        if self._scoped:
            context.launch_configurations, context.namespace, context.parameters, context.environment = kept


class OpaqueFunction(Action):
    """Whatever a function of the context does and returns."""

    def __init__(self, *, function, args=(), kwargs=None, **others):
        super().__init__(**others)
        self._function, self._args, self._kwargs = function, args, kwargs or {}

    def execute(self, context):
        """Call it, and visit what it returns."""
        context.visit(self._function(context, *self._args, **self._kwargs))


class IncludeLaunchDescription(Action):
    """Another launch file, with arguments."""

    def __init__(self, launch_description_source, *, launch_arguments=(), **kwargs):
        super().__init__(**kwargs)
        self._source, self._arguments = launch_description_source, launch_arguments

    def execute(self, context):
        """Visit what it describes."""
        if not isinstance(self._source, (LaunchDescription, PythonLaunchDescriptionSource)):
            raise LaunchError("a launch file includes another than one in Python")
        for name, value in self._arguments:
            context.launch_configurations[context.perform_substitution(name)] = context.perform_substitution(value)
        context.visit(self._source if isinstance(self._source, LaunchDescription) else self._source.load(context))


class LogInfo(Action):
    """Says something."""

    def __init__(self, *, msg, **kwargs):
        super().__init__(**kwargs)
        self._message = msg

    def execute(self, context):
        """Say it."""
        context.processes.say("INFO", "launch.user", context.perform_substitution(self._message))


class RegisterEventHandler(Action):
    """From now on something is done when something happens."""

    def __init__(self, event_handler, **kwargs):
        super().__init__(**kwargs)
        self._handler = event_handler

    def execute(self, context):
        """Note it."""
        context.handlers.append(self._handler)


class Shutdown(Action):
    """Ends everything."""

    def __init__(self, *, reason="reason not given", **kwargs):
        super().__init__(**kwargs)
        self._reason = reason

    def execute(self, context):
        """Ask for it."""
        context.processes.stop(self._reason)


class EmitEvent(Shutdown):
    """Makes an event happen: `launch.events.Shutdown`, the only one here."""

    def __init__(self, *, event, **kwargs):
        super().__init__(reason=event.reason, **kwargs)


class ExecuteProcess(Action):
    """A process; `output` is always the terminal."""

    def __init__(
        self, *, cmd, name=None, cwd=None, additional_env=None, output=None, on_exit=None, shell=False, **kwargs
    ):
        super().__init__(**kwargs)
        self._cmd, self._name, self._cwd, self._shell = cmd, name, cwd, shell
        self._environment, self.on_exit = additional_env or {}, on_exit

    def command(self, context):
        """Return its words."""
        words = [context.perform_substitution(word) for word in self._cmd]
        return ["/bin/sh", "-c", " ".join(words)] if self._shell else words

    def execute(self, context):
        """Start it."""
        words, text = self.command(context), context.perform_substitution
        name = text(self._name) if self._name else words[0].rsplit("/", 1)[-1]
        own = {text(key): text(value) for key, value in self._environment.items()}
        folder = text(self._cwd) if self._cwd else None
        context.processes.start(self, name, words, {**context.environment, **own}, folder)
