"""Pieces of a recording that grows: every reader gets all of them, from the first on."""

import threading

import pytest
from trackvib_sim.view.server import Pieces

pytestmark = pytest.mark.property


def read_all(pieces):
    """Read as a browser does, until there will be no more."""
    read = []
    while True:
        try:
            piece = pieces.get(len(read))
        except IndexError:
            return read
        if piece is not None:  # else it has not come yet, and is asked for again
            read.append(piece)


def test_every_reader_gets_every_piece():
    """One that comes before the first piece, and one that comes after the last."""
    pieces, early = Pieces(), []
    reader = threading.Thread(target=lambda: early.extend(read_all(pieces)))
    reader.start()
    made = [bytes([number]) * number for number in range(1, 50)]
    for piece in made:
        pieces.add(piece)
    pieces.complete()
    reader.join()
    assert early == read_all(pieces) == made


def test_what_never_comes_is_told():
    """A reader of a recording without a piece ends, too."""
    pieces = Pieces()
    pieces.complete()
    with pytest.raises(IndexError):
        pieces.get(0)
