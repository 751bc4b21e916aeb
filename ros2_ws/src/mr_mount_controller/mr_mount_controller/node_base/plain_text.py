"""Text as it may be shown: from outside (names of files, topics and nodes, what a bag tells), numbers and ranges."""

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


def number(value):
    """Return a number as one writes it: 0.3, 1000000, 2e12; without the digits that rounding leaves."""
    digits, _, power = f"{value:.10g}".partition("e")
    return f"{digits}e{int(power)}" if power else digits


def span(low, high, unit=""):
    """Return a range in words, such as "0.1 to 2 m"."""
    return f"{number(low)} to {number(high)} {unit}".rstrip()
