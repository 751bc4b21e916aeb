"""Damaged bags: up to three flipped bits and a cut. Repair must keep every message of every chunk that is intact."""

import sys
import tempfile
from collections import Counter
from pathlib import Path

from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.mcap_summary import examine
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.repair import repair

from .trial import Wrong

sys.path.append(str(Path(__file__).parents[2] / "ros2_ws" / "src" / "trackvib_sim" / "test" / "bags"))
import hostile_bags as made

REFUSALS = (BagError,)


def trials(chance, count):
    """Yield so many damaged bags."""
    kinds = [made.sound_file(kind, sums) for kind in made.COMPRESSIONS for sums in (True, False)]
    sound = [(data, made.chunks_of(data)) for data in kinds]
    for _ in range(count):
        data, chunks = chance.choice(sound)
        edges = [edge + offset for chunk in chunks for edge in chunk[:2] for offset in range(60)]
        places = [
            chance.choice((chance.choice(edges), chance.randrange(len(data)))) for _ in range(chance.randint(0, 3))
        ]
        flips = [(place, chance.randrange(8)) for place in places]
        size = chance.choice((len(data), chance.randrange(100, len(data))))
        yield f"flips {flips}, size {size}", lambda args=(data, chunks, flips, size): _attempt(*args)


def _messages(bag):
    """Return the messages of a bag with their numbers."""
    records = (record for record in raw_records(bag) if isinstance(record, RawMessage))
    return Counter(record.message.data for record in records if record.message is not None)


def _attempt(data, chunks, flips, size):
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder)
        (bag / made.NAME).write_bytes(made.damaged(data, flips, size))
        before = _messages(bag)
        repair(bag)
        lost = (Counter(made.intact_messages(chunks, flips, size)) | before) - _messages(bag)
        flaw = examine(bag / made.NAME).flaw
    if lost or flaw:
        raise Wrong(f"lost {sum(lost.values())}, {flaw}")
    return "repaired"
