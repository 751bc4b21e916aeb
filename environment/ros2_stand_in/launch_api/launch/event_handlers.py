"""What is done when something happens."""


class _EventHandler:
    def process_ended(self, context, action):
        """Called for the action whose process has ended."""

    def shut_down(self, context):
        """Called once, when everything ends."""


class OnProcessExit(_EventHandler):
    """When a process, or any if none is named, has ended."""

    def __init__(self, *, target_action=None, on_exit):
        self._target, self._on_exit = target_action, on_exit

    def process_ended(self, context, action):
        """Do it for the action whose process has ended, if it is the one."""
        if self._target in (None, action):
            context.visit(self._on_exit(action, context) if callable(self._on_exit) else self._on_exit)


class OnShutdown(_EventHandler):
    """When everything ends."""

    def __init__(self, *, on_shutdown):
        self._on_shutdown = on_shutdown

    def shut_down(self, context):
        """Do it."""
        context.visit(self._on_shutdown(None, context) if callable(self._on_shutdown) else self._on_shutdown)
