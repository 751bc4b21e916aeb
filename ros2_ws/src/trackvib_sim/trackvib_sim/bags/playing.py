"""Opens a bag for playing: raw messages in order of time, and the quality of service with which they came."""

from collections import Counter

from mcap.exceptions import InvalidMagic
from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.interfaces import QosDurability, QosReliability
from rosbags.rosbag2 import ReaderError

from ..yaml_text import YamlTextError
from .errors import BagError
from .files import bag_files
from .limits import TooLarge, largest_record, too_large
from .mcap_records import DAMAGE
from .mcap_summary import examine
from .metadata import declared_qos

# what rosbags' reader does with definitions and records that it does not expect
_READ_ERRORS = (OSError, AnyReaderError, ReaderError, *DAMAGE, LookupError, TypeError, AttributeError, AssertionError)


def open_bag(path):
    """Return an open `rosbags.highlevel.AnyReader` of a bag folder, to be closed by the caller.

    That reader trusts a bag, so the whole of it is examined before.

    Raises
    ------
    BagError
        There is no such bag, it holds no messages, it is damaged, or it cannot be read.
    """
    files = bag_files(path)
    for file in files:
        try:
            _require_sound(file)
        except (OSError, TooLarge, YamlTextError) as error:
            raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None
    try:
        reader = AnyReader(files)
        reader.open()
    except _READ_ERRORS as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None
    if not reader.message_count:
        reader.close()
        raise BagError(f"bag {str(path)!r} holds no messages")
    return reader


def _require_sound(file):
    """Raise an error unless a file is whole, can be read in order of time in bounded memory, and its QoS is read."""
    try:
        findings = examine(file)
    except InvalidMagic:
        raise BagError(f"{str(file)!r} is no MCAP file") from None
    if findings.flaw:
        raise BagError(f"bag file {str(file)!r} is {findings.flaw}; `trackvib bag repair` completes it")
    for channel in findings.channels:
        declared_qos(channel)
    # all chunks that overlap in time are held at once
    change = Counter()
    for chunk in findings.chunks:
        change[chunk.message_start_time, 0] += chunk.uncompressed_size
        change[chunk.message_end_time, 1] -= chunk.uncompressed_size
    together = 0
    for _, size in sorted(change.items()):
        together += size
        if together > largest_record():
            raise too_large(f"what file {file.name!r} holds for one time", together)


def is_latched(connection):
    """Return whether the messages of a connection were kept for late joiners (transient local)."""
    offers = connection.ext.offered_qos_profiles
    return bool(offers) and all(offer.durability == QosDurability.TRANSIENT_LOCAL for offer in offers)


def is_best_effort(connection):
    """Return whether the messages of a connection could be lost on their way."""
    return any(offer.reliability == QosReliability.BEST_EFFORT for offer in connection.ext.offered_qos_profiles)
