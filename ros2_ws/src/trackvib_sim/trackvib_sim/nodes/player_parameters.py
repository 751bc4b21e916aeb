"""Parameters of the player node."""

from mr_mount_controller.node_base.parameters import Parameter

from ..bags.limits import LARGEST_CHUNKS, largest_chunk

PARAMETERS = (
    Parameter("bag", "", "Folder of the bag, or one .mcap file."),
    Parameter("rate", 1.0, "Bag time per wall time.", "", 0.01, 100.0),
    Parameter("start", 0.0, "Start time, relative to the first message of the bag.", "s", 0.0, 1e6),
    Parameter("end", 0.0, "End time, relative to the first message of the bag; 0 for the last message.", "s", 0.0, 1e6),
    Parameter("loop", False, "Start again at the end."),
    Parameter("topics", ["*"], "Topics to play, by name or pattern (`*`, `?`)."),
    Parameter(
        "largest_chunk", largest_chunk.get(), "Largest accepted size of a record of the bag.", "MiB", *LARGEST_CHUNKS
    ),
)
