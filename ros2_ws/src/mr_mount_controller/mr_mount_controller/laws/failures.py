"""What a user's own code raises, in one line: which exception, its text as signs, and where."""

import importlib
import inspect
import sys
import traceback
from contextlib import suppress

from ..node_base.plain_text import plain_line, shortened
from .base import ControlLaw

FAILURES = (Exception, SystemExit)  # all that may come of it, but for Ctrl-C
_OF_IMPORT = (importlib.__file__, "<frozen ")


def reason_of(error, kind=None):
    """Return what an exception says, with file and line in a law's own code.

    `kind` is the class of the law, None while its module is loaded.
    """
    text = ""
    with suppress(*FAILURES):
        text = f": {error}" if str(error) else ""
    return plain_line(f"{type(error).__name__}{shortened(text, 1000)}{_place(error, kind)}")


def place_of(function):
    """Return file and line of a function's code, as an addition to a sentence; empty if it is not Python."""
    code = getattr(inspect.unwrap(function), "__code__", None)
    return plain_line(f" ({code.co_filename}, line {code.co_firstlineno})") if code else ""


def _place(error, kind):
    """The innermost line in the files of a law and its bases; without a law, the innermost line of a module."""
    found = traceback.extract_tb(error.__traceback__)[1:]  # the first is the caller's
    if kind is None:
        found = [each for each in found if not each.filename.startswith(_OF_IMPORT)]
    else:
        classes = kind.__mro__[: kind.__mro__.index(ControlLaw)]
        own = {getattr(sys.modules.get(each.__module__), "__file__", None) for each in classes}
        found = [each for each in found if each.filename in own]
    if found:
        return f" ({found[-1].filename}, line {found[-1].lineno})"
    return "" if kind is None else place_of(kind.update)  # it cannot be called
