"""Messages as they were before there could be any number of mounts: two of each, in arrays; and bags of them."""

from mcap.records import Metadata
from mcap.writer import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from trackvib_sim.bags.definitions import Definition
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.schemas import schema_text

FIELDS = {
    "CoilCurrent": "std_msgs/Header header\nbuiltin_interfaces/Time sample_stamp\nfloat64[2] current\n",
    "MountState": "std_msgs/Header header\nfloat64[2] current\nfloat64[2] stiffness\nfloat64[2] damping\n"
    "geometry_msgs/Vector3[2] deflection\ngeometry_msgs/Vector3[2] velocity\ngeometry_msgs/Vector3[2] force\n"
    "float64[2] dissipated_power\n",
}
NEW = "trackvib_msgs/msg/MountDescription"


def old_text(type_name):
    """Return the definition of a message type with all that it depends on, as a bag of then has it."""
    text = schema_text(type_name)
    fields = FIELDS.get(type_name.rpartition("/")[2])
    return text if fields is None else fields + text[text.index("=" * 80) :]


def aged(bag, folder):
    """Copy a bag to a new folder as it would have been recorded then; returns the folder."""
    folder.mkdir()
    channels, turned = {}, {}
    with (folder / "old_0.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="test")
        for record in raw_records(bag):
            if isinstance(record, Metadata):
                writer.add_metadata(record.name, dict(record.metadata))
            if not isinstance(record, RawMessage) or record.type_name == NEW:
                continue
            if record.topic not in channels:
                schema = writer.register_schema(record.type_name, "ros2msg", old_text(record.type_name).encode())
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(old_text(record.type_name), record.type_name))
                metadata = {**record.channel.metadata, "topic_type_hash": store.hash_rihs01(record.type_name)}
                channels[record.topic] = writer.register_channel(record.topic, "cdr", schema, metadata)
                turned[record.topic] = _turned(record.type_name, store)
            if record.message is not None:
                time, data = record.message.log_time, turned[record.topic](record.message.data)
                writer.add_message(channels[record.topic], time, data, time)
        writer.finish()
    return folder


def _turned(type_name, store):
    """Return what makes bytes of then, whose definitions are in a typestore, of those of now."""
    if type_name.rpartition("/")[2] not in FIELDS:
        return bytes
    now = Definition(type_name, "ros2msg", schema_text(type_name).encode())
    return lambda data: bytes(store.serialize_cdr(now.message(data), type_name))
