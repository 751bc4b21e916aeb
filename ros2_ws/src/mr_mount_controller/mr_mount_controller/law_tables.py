"""The control laws with their parameters as a table for docs/controllers.md, made from the classes themselves.

    ./trackvib exec -- python -m mr_mount_controller.law_tables docs/controllers.md

renews what stands between `<!-- parameters -->` and `<!-- /parameters -->` in a Markdown file.
"""

import re
import sys
from pathlib import Path

from .laws import find_law, known_laws

HEAD = ("parameter", "default", "accepted", "meaning")


def shipped_laws():
    """Return the names of the laws of this package."""
    return [name for name in known_laws() if find_law(name).__module__.startswith(f"{__package__}.")]


def table(names):
    """Return a Markdown table of laws by name: a row with what each does, then one for each parameter."""
    rows = [HEAD, ("---",) * len(HEAD)]
    for name in names:
        law = find_law(name)
        rows.append((f"**{name}**", "", "", law.__doc__.splitlines()[0]))
        for each in law.parameters:
            low_to_high = "" if each.low is None else f"{each.low:g} to {each.high:g} {each.unit}".rstrip()
            rows.append((f"`{each.name}`", f"`{each.default}`", low_to_high, each.description))
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def renewed(document):
    """Return a Markdown document with its table renewed.

    Raises
    ------
    ValueError
        The pair of marks is not there once.
    """
    parts = re.split("(?<=<!-- parameters -->\n).*?(?=<!-- /parameters -->)", document, flags=re.DOTALL)
    if len(parts) != 2:
        marks = "<!-- parameters --> with <!-- /parameters --> below it"
        raise ValueError(f"{marks} stands {len(parts) - 1} times, must be once")
    return table(shipped_laws()).join(parts)


def main():
    """Renew the table of a document."""
    document = Path(sys.argv[1])
    document.write_text(renewed(document.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
