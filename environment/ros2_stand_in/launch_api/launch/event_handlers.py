"""What is done when something happens."""


class OnProcessExit:
    """When a process, or any if none is named, has ended."""

    def __init__(self, *, target_action=None, on_exit):
        self._target, self._on_exit = target_action, on_exit

    def handle(self, context, action):
        """Do it for the action whose process has ended, if it is the one."""
        if self._target in (None, action):
            context.visit(self._on_exit(action, context) if callable(self._on_exit) else self._on_exit)
