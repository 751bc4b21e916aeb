"""Unfolds the chunks of MCAP files within bounds, for a few bytes may claim or hold any number of them."""

from io import BytesIO

from lz4.frame import LZ4FrameDecompressor
from zstandard import CONTENTSIZE_UNKNOWN, ZstdDecompressor, get_frame_parameters

from .limits import MIB, largest_record, too_large


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
    if compression == "zstd" and size > bound and _zstd_claim(data) == size:
        raise too_large(f"{what}, unfolded,", size)
    contents = COMPRESSIONS[compression](data, bound + 1)
    if len(contents) > size:
        raise ValueError(f"holds more than the {size} bytes that it declares")
    if len(contents) > bound:
        raise too_large(f"{what}, unfolded,", size)
    return contents


def _zstd(data, most):
    # a window is never larger than what is accepted of a chunk
    window = max(largest_record(), MIB)
    return ZstdDecompressor(max_window_size=window).stream_reader(BytesIO(data)).read(most)


def _zstd_claim(data):
    """Return how many bytes a frame claims to hold, None if it does not say."""
    claim = get_frame_parameters(data).content_size
    return None if claim == CONTENTSIZE_UNKNOWN else claim


def _lz4(data, most):
    try:
        return LZ4FrameDecompressor().decompress(data, max_length=most)
    except RuntimeError as error:
        raise ValueError(str(error)) from None


COMPRESSIONS = {"": lambda data, most: data[:most], "zstd": _zstd, "lz4": _lz4}  # as MCAP names them
