"""Opens a bag for playing: raw messages in order of time, and the quality of service with which they came."""

from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.interfaces import QosDurability, QosReliability
from rosbags.rosbag2 import ReaderError

from .errors import BagError
from .files import bag_files
from .mcap_records import DAMAGE


def open_bag(path):
    """Return an open `rosbags.highlevel.AnyReader` of a bag folder, to be closed by the caller.

    Raises
    ------
    BagError
        There is no such bag, it holds no messages, or it cannot be read.
    """
    try:
        reader = AnyReader(bag_files(path))
        reader.open()
    except (OSError, AnyReaderError, ReaderError, *DAMAGE) as error:
        hint = "if it was cut short, `trackvib bag repair` completes it"
        raise BagError(f"bag {str(path)!r} cannot be read: {error}; {hint}") from None
    if not reader.message_count:
        reader.close()
        raise BagError(f"bag {str(path)!r} holds no messages")
    return reader


def is_latched(connection):
    """Return whether the messages of a connection were kept for late joiners (transient local)."""
    offers = connection.ext.offered_qos_profiles
    return bool(offers) and all(offer.durability == QosDurability.TRANSIENT_LOCAL for offer in offers)


def is_best_effort(connection):
    """Return whether the messages of a connection could be lost on their way."""
    return any(offer.reliability == QosReliability.BEST_EFFORT for offer in connection.ext.offered_qos_profiles)
