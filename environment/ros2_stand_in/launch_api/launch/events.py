"""Events that `launch.actions.EmitEvent` takes."""


class Shutdown:
    """End everything."""

    def __init__(self, *, reason="reason not given"):
        self.reason = reason
