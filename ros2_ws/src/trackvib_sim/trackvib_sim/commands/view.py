"""`trackvib view`: a recorded run in the browser, as a recording of Rerun, or as an animated picture."""

import threading
from math import inf
from pathlib import Path

from ..bags.reading import read_recording
from ..view.motion import Span, read_motion
from .result_folder import CommandError, whole_or_none

_FRAME_RATE, _PICTURE_RATE = 50.0, 12.5  # frames a second of simulated time


def run_view(bag, wanted, save, gif, port, console):
    """Show a bag, or leave a file of it; `wanted` are rate, start and end, the first and last of which may be None.

    Raises
    ------
    BagError, ValueError, CommandError, OSError, ImportError
        It cannot be shown; the message says why.
    """
    rate, start, end = wanted
    span = Span(rate or (_PICTURE_RATE if gif else _FRAME_RATE), start, inf if end is None else end)
    recording = read_recording(bag)
    vehicle, motion = read_motion(recording, span, console)
    if motion.note:
        console.print(f"note: {motion.note}", soft_wrap=True)
    title = f"{vehicle.name}, {Path(bag).absolute().name}"
    if gif:
        from ..view.animated_picture import animated_picture

        with whole_or_none(Path(gif)) as (path,):
            animated_picture(recording, vehicle, motion, path, console)
        console.print(f"{len(motion.time)} frames in {gif}", soft_wrap=True)
        return
    from ..view.rerun_recording import new_stream, write_run  # imported late: a picture needs no Rerun

    stream = new_stream(title)
    if save:
        with whole_or_none(Path(save)) as (path,):
            stream.save(str(path))
            write_run(stream, recording, vehicle, motion)
            stream.disconnect()
        console.print(f"{len(motion.time)} frames in {save}", soft_wrap=True)
        return
    binary = stream.binary_stream()
    write_run(stream, recording, vehicle, motion)
    with Served(port, title, console) as served:
        served.show([binary.read(flush=True)])
        served.wait()


class Served:
    """A view that is served until the block ends, on a port of this machine; 0 for a free one.

    Raises
    ------
    CommandError
        The viewer's files cannot be had, or the port is taken.
    """

    def __init__(self, port, title, console):
        from ..view.server import Pieces, ViewServer
        from ..view.viewer_files import NoViewer

        self._console, self._pieces = console, Pieces()
        try:
            self._server = ViewServer(port, self._pieces)
        except NoViewer as error:
            raise CommandError(str(error)) from None
        except OSError as error:
            raise CommandError(f"cannot serve on port {port}: {error.strerror}") from None
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        where = f"open {self._server.address} in a browser on this machine; Ctrl-C ends the view"
        console.print(f"{title}: {where}", soft_wrap=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._server.shutdown()
        self._server.server_close()

    def show(self, pieces):
        """Show the pieces of a recording, which may come one after the other."""
        for piece in pieces:
            self._pieces.add(piece)
        self._pieces.complete()

    def wait(self):
        """Wait for Ctrl-C."""
        try:
            self._thread.join()
        except KeyboardInterrupt:
            self._console.print("the view has ended")
