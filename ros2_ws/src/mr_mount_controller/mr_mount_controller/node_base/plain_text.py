"""Text from outside (names of files, topics and nodes, what a bag or a file tells) as it may be shown."""

LONGEST_LINE = 2000  # characters


def readable(text):
    """Return a text in which nothing but signs is left.

    Whatever would move the cursor, colour, title or turn the terminal, C0 and C1 characters, newlines, directional
    overrides, becomes its escape sequence as Python writes it.
    """
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape").decode() for sign in text)


def shortened(text, longest=200):
    """Return a text, without its middle if it is longer than so many characters."""
    return text if len(text) <= longest else f"{text[: longest // 2]} ... {text[-(longest // 2) :]}"


def plain_line(text):
    """Return a text as one line of signs, without its middle if it is longer than `LONGEST_LINE`."""
    return shortened(readable(text), LONGEST_LINE)
