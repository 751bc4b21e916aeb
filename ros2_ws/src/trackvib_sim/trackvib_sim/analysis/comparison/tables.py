"""A `Comparison` as files: CSV and JSON."""

import csv
import json
from dataclasses import asdict, fields
from math import isfinite

from .compare import Ratio


def write_comparison(comparison, folder):
    """Write comparison.json and comparison.csv to a folder; what cannot be had is null, or an empty cell."""
    document = asdict(comparison)
    document["ratios"] = [{name: _known(value) for name, value in each.items()} for each in document["ratios"]]
    document["band"] = [_known(each) for each in document["band"]]
    text = json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False)
    (folder / "comparison.json").write_text(text + "\n", encoding="utf-8")
    with (folder / "comparison.csv").open("w", encoding="utf-8", newline="") as file:
        rows = csv.DictWriter(file, [field.name for field in fields(Ratio)])
        rows.writeheader()
        rows.writerows(document["ratios"])


def _known(value):
    return None if isinstance(value, float) and not isfinite(value) else value
