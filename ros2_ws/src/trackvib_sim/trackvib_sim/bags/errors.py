"""What goes wrong with bags."""


class BagError(RuntimeError):
    """A bag cannot be written or read; the message names it and says why.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.read_recording("nowhere")
    Traceback (most recent call last):
    trackvib_sim.bags.errors.BagError: bag 'nowhere' does not exist
    """
