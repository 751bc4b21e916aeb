"""What `trackvib bag` does: shows what is in a bag, and completes one that was cut short."""

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from ..bags.contents import contents
from ..bags.repair import repair
from ..numerics.units import NANO


def run_info(path):
    """Print topics, times and origin of a bag; raises `BagError`."""
    found, console = contents(path), Console(highlight=False, markup=False)
    table = Table(title=str(path), title_justify="left")
    for name in ("topic", "type", "messages"):
        table.add_column(name, justify="right" if name == "messages" else "left")
    for topic, type_name in sorted(found.types.items()):
        table.add_row(topic, type_name, str(found.counts[topic]))
    console.print(table)
    for line in (
        f"{found.counts.total()} messages from {found.first / NANO:.3f} to {found.last / NANO:.3f} s",
        f"{found.size / 1e6:.1f} MB in {', '.join(file.name for file in found.files)}; compression "
        f"{', '.join(sorted(found.compression)) or 'none'}",
        f"provenance: {', '.join(found.provenance) or 'none'}",
        f"attachments: {', '.join(found.attachments) or 'none'}",
    ):
        console.print(line, soft_wrap=True)


def run_repair(path):
    """Repair a bag and print what was done; raises `BagError`."""
    console = Console(highlight=False, markup=False)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("repairing")
        done = repair(path, lambda read, size: progress.update(task, completed=read, total=size))
    for file in done.files:
        words = [f"{file.file}: {file.messages} messages kept, index restored."]
        if file.unread:
            words.append(f"Its last {file.unread} bytes were no whole record; what could be read of them is kept.")
        if file.damaged_chunks:
            words.append(f"Chunks with a wrong checksum, which are left out: {file.damaged_chunks}.")
        console.print(*words, f"The file as it was: {file.original.name}", soft_wrap=True)
    if done.metadata:
        console.print("metadata.yaml written", soft_wrap=True)
    elif not done.files:
        console.print(f"{path}: sound, nothing to do", soft_wrap=True)
