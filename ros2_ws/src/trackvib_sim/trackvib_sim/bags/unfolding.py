"""Unfolds what is compressed in a bag within bounds, for a few bytes may claim or hold any number of them."""

from io import BytesIO

import numpy as np
from lz4.frame import LZ4FrameDecompressor
from zstandard import CONTENTSIZE_UNKNOWN, ZstdDecompressor, get_frame_parameters

from .limits import MIB, largest_record, too_large
from .mcap_messages import at

ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"  # with which a frame begins, and no message of CDR
_MAGIC = np.dtype("V4")
_CHUNK = 1 << 20  # bytes that are unfolded at once


def unfold(compression, data, size, what):
    """Return the contents of a chunk, fewer bytes than it declares if some of it is missing.

    Parameters
    ----------
    compression : str
        One of `COMPRESSIONS`.
    data : bytes
    size : int
        How many bytes the chunk declares to hold, whatever it does hold.
    what : str
        Names the chunk with its place.

    Raises
    ------
    TooLarge
        It declares more than is accepted, and holds it.
    ValueError, zstandard.ZstdError
        It holds more than it declares, or cannot be unfolded.
    """
    bound = min(size, largest_record())
    if compression == "zstd" and size > bound and zstd_claim(data) == size:
        raise too_large(f"{what}, decompressed,", size)
    contents = COMPRESSIONS[compression](data, bound + 1)
    if len(contents) > size:
        raise ValueError(f"holds more than the {size} bytes that it declares")
    if len(contents) > bound:
        raise too_large(f"{what}, decompressed,", size)
    return contents


def unfold_message(data):
    """Return a message's bytes, unfolded if they are compressed as rosbag2 does by `--compression-mode message`.

    Raises as `unfold` does.
    """
    if data[:4] != ZSTD_MAGIC:
        return data
    return _message(data, largest_record())


def unfold_messages(data, start, size):
    """Return bytes of messages and where each stands, those that are compressed unfolded, all together within bounds.

    Parameters
    ----------
    data : (n,) uint8
    start, size : (k,) int
        Of each message.

    Raises as `unfold` does.
    """
    if not are_compressed(data, start, size):
        return data, start, size
    messages, left = [], largest_record()
    for begin, length in zip(start.tolist(), size.tolist(), strict=True):
        message = data[begin : begin + length].tobytes()
        messages.append(_message(message, left) if message.startswith(ZSTD_MAGIC) else message)
        left -= len(messages[-1])
    size = np.array([len(message) for message in messages], np.int64)
    return np.frombuffer(b"".join(messages), np.uint8), np.cumsum(size) - size, size


def are_compressed(data, start, size):
    """Return whether any of the messages (k,) in some bytes (n,) uint8 is."""
    return bool((at(data, _MAGIC, start[size >= _MAGIC.itemsize]) == np.frombuffer(ZSTD_MAGIC, _MAGIC)).any())


def unfolded_parts(stream):
    """Yield what a compressed file holds, part after part; of one that is cut short, as far as it goes."""
    reader = _decompressor().stream_reader(stream, read_across_frames=True)
    while part := reader.read(_CHUNK):
        yield part


def _message(data, most):
    claim = zstd_claim(data)
    if claim is not None and claim > most:
        raise too_large("a decompressed message or chunk", claim)
    message = _zstd(data, most + 1)
    if len(message) > most:
        raise too_large("a decompressed message or chunk", len(message))
    if claim not in (None, len(message)):
        raise ValueError(f"a compressed message of {claim} bytes holds {len(message)}")
    return message


def _decompressor():
    # a window is never larger than what is accepted of a chunk
    return ZstdDecompressor(max_window_size=max(largest_record(), MIB))


def _zstd(data, most):
    return _decompressor().stream_reader(BytesIO(data), read_across_frames=True).read(most)


def zstd_claim(data):
    """Return how many bytes a frame claims to hold, None if it does not say."""
    claim = get_frame_parameters(data).content_size
    return None if claim == CONTENTSIZE_UNKNOWN else claim


def _lz4(data, most):
    try:
        return LZ4FrameDecompressor().decompress(data, max_length=most)
    except RuntimeError as error:
        raise ValueError(str(error)) from None


COMPRESSIONS = {"": lambda data, most: data[:most], "zstd": _zstd, "lz4": _lz4}  # as MCAP names them
