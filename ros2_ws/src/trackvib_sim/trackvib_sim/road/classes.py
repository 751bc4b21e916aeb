"""The classes of roads of ISO 8608."""

CLASSES = tuple("ABCDEFGH")  # from smooth to rough
