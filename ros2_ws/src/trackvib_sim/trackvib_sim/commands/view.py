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
    serve([binary.read(flush=True)], port, title, console)


def serve(pieces, port, title, console):
    """Serve the view of some pieces, which may come one after the other, until Ctrl-C. Raises as `run_view` does."""
    from ..view.server import Pieces, ViewServer
    from ..view.viewer_files import NoViewer

    held = Pieces()
    try:
        server = ViewServer(port, held)
    except NoViewer as error:
        raise CommandError(str(error)) from None
    except OSError as error:
        raise CommandError(f"port {port} cannot be served on: {error.strerror}") from None
    with server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        console.print(f"{title}: open {server.address} in a browser on this machine; Ctrl-C ends the view", soft_wrap=True)
        try:
            for piece in pieces:
                held.add(piece)
            held.complete()
            thread.join()
        except KeyboardInterrupt:
            console.print("the view has ended")
        finally:
            server.shutdown()
