"""Serves the viewer to browsers of this machine: from loopback only, and with a policy that lets nothing leave it.

Rerun's viewer would call home, and its page fetches a font. So its two files come with a page of ours, from a server of
ours, under a Content-Security-Policy by which a browser makes requests to this server only.
"""

import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files

from .viewer_files import FILES, LOOPBACK, viewer_files

_POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; style-src 'unsafe-inline'; "
    "img-src 'self' data: blob:; worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_PAGE = {"index.html": "text/html; charset=utf-8", "view.js": "text/javascript; charset=utf-8"}
_PATIENCE = 5.0  # s that a browser waits for the next piece before it asks again


class Pieces:
    """The pieces of a recording, which may grow; any number of browsers read them from the first on."""

    def __init__(self):
        self._pieces, self._complete, self._more = [], False, threading.Condition()

    def add(self, data):
        """Add some bytes, a whole recording of Rerun or the next part of one."""
        with self._more:
            self._pieces.append(data)
            self._more.notify_all()

    def complete(self):
        """Say that there will be no more."""
        with self._more:
            self._complete = True
            self._more.notify_all()

    def get(self, number):
        """Return a piece, None if it has not come within some seconds; raise `IndexError` if it never will."""
        with self._more:
            self._more.wait_for(lambda: number < len(self._pieces) or self._complete, _PATIENCE)
            if number < len(self._pieces):
                return self._pieces[number]
            if self._complete:
                raise IndexError(number)
            return None


class ViewServer(ThreadingHTTPServer):
    """Serves `pieces` with the viewer on a port of loopback; 0 for a free one.

    Raises
    ------
    OSError
        The port is taken.
    viewer_files.NoViewer
        The viewer's files cannot be had.
    """

    daemon_threads = True

    def __init__(self, port, pieces):
        super().__init__((LOOPBACK, port), _Handler)
        self.pieces = pieces
        page = files(__package__) / "page"
        self.contents = {name: (kind, (page / name).read_bytes()) for name, kind in _PAGE.items()}
        self.contents |= {name: (FILES[name], data) for name, data in viewer_files().items()}
        self.contents[""] = self.contents["index.html"]

    @property
    def address(self):
        """Where a browser finds it."""
        return f"http://{LOOPBACK}:{self.server_port}/"

    def handle_error(self, request, client_address):
        """Say nothing of a browser that has gone."""


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_GET(self):
        """Answer with a file, or a piece of the recording."""
        # a page elsewhere could have its own name point here
        if self.headers.get("Host") not in {f"{name}:{self.server.server_port}" for name in (LOOPBACK, "localhost")}:
            return self._answer(HTTPStatus.FORBIDDEN)
        name = self.path.partition("?")[0].removeprefix("/")
        if name in self.server.contents:
            return self._answer(HTTPStatus.OK, *self.server.contents[name])
        folder, _, number = name.partition("/")
        if folder != "pieces" or not (number.isascii() and number.isdigit() and len(number) < 10):
            return self._answer(HTTPStatus.NOT_FOUND)
        try:
            piece = self.server.pieces.get(int(number))
        except IndexError:
            return self._answer(HTTPStatus.GONE)
        if piece is None:
            return self._answer(HTTPStatus.NO_CONTENT)
        return self._answer(HTTPStatus.OK, "application/octet-stream", piece)

    def _answer(self, status, kind="text/plain", data=b""):
        self.send_response(status)
        self.send_header("Content-Security-Policy", _POLICY)
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Cache-Control", "no-store")
        if status != HTTPStatus.NO_CONTENT:
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, format, *arguments):
        """Print nothing."""
