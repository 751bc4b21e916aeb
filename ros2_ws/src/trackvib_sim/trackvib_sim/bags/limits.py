"""How much memory a bag may ask for, whatever it claims or holds."""

from contextvars import ContextVar

MIB = 1 << 20
LARGEST_CHUNKS = (1, 1 << 14)  # MiB, what may be chosen

# MiB that a chunk may hold when it is unfolded, and any other record; recorders make chunks of a few MiB. The command
# line's --largest-chunk and the player's parameter `largest_chunk` set it.
largest_chunk = ContextVar("largest_chunk", default=64)


class TooLarge(Exception):
    """A record that needs more memory than is accepted; the message names it, its size and what is accepted."""


def largest_record():
    """Return how many bytes a record may have, a chunk when it is unfolded."""
    return largest_chunk.get() * MIB


def too_large(what, size):
    """Return the error for something of `size` bytes; `what` names it with its place."""
    accepted = f"accepted: {largest_record()} ({largest_chunk.get()} MiB; --largest-chunk raises it)"
    return TooLarge(f"{what} has {size} bytes, {accepted}")
