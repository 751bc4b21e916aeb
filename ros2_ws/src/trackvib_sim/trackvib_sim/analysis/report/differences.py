"""What differs between the runs of several bags, by the parameters and the vehicle files in them."""

from ...bags.provenance import parameters
from ...yaml_text import load
from .facts import UNKNOWN


def differing(report_data_list):
    """Return rows (node, parameter, value in each bag) of what is not the same everywhere; vehicles come last."""
    by_node = [
        {node.rpartition("/")[2]: values for node, values in parameters(report_data.provenance).items()}
        for report_data in report_data_list
    ]
    keys = sorted({(node, name) for each in by_node for node, values in each.items() for name in values})
    rows = [(node, name, *(each.get(node, {}).get(name, UNKNOWN) for each in by_node)) for node, name in keys]
    return [row for row in rows if len(set(row[2:])) > 1] + _of_vehicles(
        [report_data.vehicle for report_data in report_data_list]
    )


def _of_vehicles(texts):
    """Return the rows of vehicle files; of those that cannot be read one row says so, and the others are compared."""
    if len(set(texts)) == 1:
        return []
    files = [_entries(text) for text in texts]
    rows = []
    if None in files:
        words = (
            "there" if entries is not None else "not a YAML file with sections" if text else UNKNOWN
            for text, entries in zip(texts, files, strict=True)
        )
        rows.append(("vehicle", "file", *words))
    for key in dict.fromkeys(key for entries in files if entries for key in entries):
        values = [None if entries is None else entries.get(key, UNKNOWN) for entries in files]
        if len({value for value in values if value is not None}) > 1:
            rows.append(("vehicle", key, *("–" if value is None else value for value in values)))
    return rows


def _entries(text):
    """Return a vehicle file's entries as text by their flattened keys; None of a text that is none."""
    try:
        content = load(text or "", "vehicle")
        return dict(_flat(content)) if isinstance(content, dict) else None
    except ValueError:  # as `load` raises it, and from integers too long to be written out
        return None


def _flat(section, above=""):
    """Iterate over a section's entries; notes and sources of an item are left out, they change no run."""
    for name, item in section.items():
        key = f"{above}{name}"
        if not isinstance(item, dict):
            yield key, str(item)
        elif "value" in item:
            yield key, " ".join(str(item[part]) for part in ("value", "unit") if part in item)
        else:
            yield from _flat(item, f"{key}.")
