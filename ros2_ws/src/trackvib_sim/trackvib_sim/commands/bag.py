"""What `trackvib bag` does: shows what is in a bag, and completes one that was cut short or damaged."""

from mr_mount_controller.node_base.plain_text import shortened
from rich.table import Table

from ..bags.contents import contents
from ..bags.repair import NO_MCAP, repair
from ..console import Terminal, progress_on
from ..numerics.units import NANO

_MOST_DAMAGE = 10  # places that are told


def run_info(path):
    """Print topics, times and origin of a bag; raises `BagError`."""
    found, console = contents(path), Terminal()
    table = Table(title=str(path), title_justify="left")
    for name in ("topic", "type", "messages"):
        table.add_column(name, justify="right" if name == "messages" else "left")
    for topic, type_name in sorted(found.types.items()):
        table.add_row(shortened(topic), shortened(type_name), str(found.counts[topic]))
    console.print(table)
    for line in (
        f"{found.counts.total()} messages from {found.first / NANO:.3f} to {found.last / NANO:.3f} s",
        f"{found.size / 1e6:.1f} MB in {', '.join(file.name for file in found.files)}; compression "
        f"{', '.join(sorted(found.compression)) or 'none'}",
        *found.notes,
        f"provenance: {', '.join(map(shortened, found.provenance)) or 'none'}",
        f"attachments: {', '.join(map(shortened, found.attachments)) or 'none'}",
    ):
        console.print(line, soft_wrap=True)


def run_repair(path):
    """Repair a bag and print what was done; raises `BagError`."""
    console = Terminal()
    with progress_on(console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("repairing")
        done = repair(path, lambda read, size: progress.update(task, completed=read, total=size))
    for file in done.files:
        for line in _words(file):
            console.print(line, soft_wrap=True)
    if not done.files:
        console.print(f"{path}: sound{'' if done.metadata else ', nothing to do'}", soft_wrap=True)
    if done.metadata:
        console.print("metadata.yaml written", soft_wrap=True)


def _words(file):
    """Yield what became of a `RepairedFile`, line by line."""
    yield f"{file.file}: was {file.flaw}"
    if file.flaw == NO_MCAP:
        yield f"  renamed to {file.original.name}"
        return
    for damage in file.damage[:_MOST_DAMAGE]:
        yield f"  {damage}"
    if len(file.damage) > _MOST_DAMAGE:
        yield f"  and {len(file.damage) - _MOST_DAMAGE} more places"
    if file.unread:
        yield f"  its last {file.unread} bytes were not a whole record; what could be read of them is kept"
    if file.lost is None:
        lost = "it had no index, so the number of lost messages is unknown"
    else:
        lost = f"{file.lost} that its index counted are lost"
    yield f"  {file.messages} messages kept, index restored; {lost}"
    yield f"  original file: {file.original.name}"
