"""What goes wrong with bags."""


class BagError(RuntimeError):
    """A bag cannot be written or read; the message names it and says why."""
