"""The set-up part of trackvib: from a bare machine to a ready ROS 2 Jazzy environment, once.

Standard library only, because it runs before anything is installed. Read `prepare.py` first.
"""


class SetupError(Exception):
    """The set-up cannot go on; the message says why and what to do about it."""
