"""What may have been meant by a name that is not known."""

from difflib import get_close_matches


def suggestion(word, known):
    """Return a sentence to add to an error, with the known name that a word resembles most; empty if none does."""
    by_small = {name.lower(): name for name in known}
    found = get_close_matches(word[:100].lower(), by_small, n=1)  # its time grows with the square of the length
    return f". Did you mean {by_small[found[0]]!r}?" if found else ""
