"""One record of an MCAP file, held against the format to its last byte.

Format: https://mcap.dev/spec, "Records".
"""

import struct
from io import BytesIO
from zlib import crc32

from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile, McapError
from mcap.opcode import Opcode
from zstandard import ZstdError

# what readers raise at bytes that are no whole record; a checksum or a text that is wrong gives a ValueError
DAMAGE = (McapError, struct.error, ValueError, ZstdError)
PRIVATE = 0x80  # opcodes from here on are free for anybody's own records
_KINDS = {
    Opcode.HEADER: records.Header,
    Opcode.FOOTER: records.Footer,
    Opcode.SCHEMA: records.Schema,
    Opcode.CHANNEL: records.Channel,
    Opcode.CHUNK_INDEX: records.ChunkIndex,
    Opcode.ATTACHMENT: records.Attachment,
    Opcode.ATTACHMENT_INDEX: records.AttachmentIndex,
    Opcode.STATISTICS: records.Statistics,
    Opcode.METADATA: records.Metadata,
    Opcode.METADATA_INDEX: records.MetadataIndex,
    Opcode.SUMMARY_OFFSET: records.SummaryOffset,
    Opcode.DATA_END: records.DataEnd,
}
_MESSAGE_HEAD = 22  # bytes before the message proper
_INDEX = struct.Struct("<HI")  # of messages: which channel, how many bytes of entries follow
_ENTRY = 16  # bytes of each


def parse(opcode, content):
    """Return mcap's record for an opcode and the content behind it; None for messages and their indexes.

    Raises
    ------
    Any of `DAMAGE`
        The content is none of such a record, or has a wrong checksum.
    """
    if opcode == Opcode.MESSAGE:
        if len(content) < _MESSAGE_HEAD:
            raise ValueError(f"a message of {len(content)} bytes, shorter than its head")
        return None
    if opcode == Opcode.MESSAGE_INDEX:
        if not is_message_index(content):
            raise ValueError("a message index whose length is wrong")
        return None
    stream = _Exact(content)
    record = _KINDS[opcode].read(stream)
    if stream.count != len(content):
        raise ValueError(f"a record of {len(content)} bytes of which {stream.count} are used")
    if opcode == Opcode.ATTACHMENT:
        (told,) = struct.unpack("<I", content[-4:])
        if told and told != crc32(content[:-4]):
            raise ValueError("an attachment with a wrong checksum")
    return record


def is_message_index(content):
    """Return whether some bytes are the content of an index of messages, whatever the opcode before them says."""
    if len(content) < _INDEX.size:
        return False
    entries = _INDEX.unpack_from(content)[1]
    return entries == len(content) - _INDEX.size and entries % _ENTRY == 0


class _Exact(ReadDataStream):
    """mcap's own takes what there is, and cannot be asked for lengths that no file has."""

    def __init__(self, content):
        super().__init__(BytesIO(content))
        self._size = len(content)

    def read(self, length):
        if length > self._size - self.count:
            raise EndOfFile
        return super().read(length)
