"""Rerun's viewer for browsers, taken out of its package: two files that its own server hands over on loopback."""

import os
import socket
import subprocess
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from urllib.error import URLError
from urllib.request import ProxyHandler, build_opener

LOOPBACK = "127.0.0.1"
FILES = {"re_viewer.js": "text/javascript", "re_viewer_bg.wasm": "application/wasm"}
_PATIENCE = 60.0  # s


class NoViewer(RuntimeError):
    """The viewer's files cannot be had; the message says why."""


def viewer_files():
    """Return the contents of `FILES` by name, as bytes.

    Raises
    ------
    NoViewer
        Rerun does not hand them over.
    """
    web, grpc = free_port(), free_port()
    words = ["--serve-web", "--bind", LOOPBACK, "--web-viewer-port", str(web), "--port", str(grpc)]
    with tempfile.TemporaryDirectory() as home:
        # it keeps settings of its own, and would report home
        variables = {**os.environ, "HOME": home, "RERUN_ANALYTICS": "off", "RUST_LOG": "error", "CI": "1"}
        server = subprocess.Popen(
            [_program(), *words],  # not by `python -m rerun`, which would be one process more to end
            env=variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        try:
            return {name: _fetched(f"http://{LOOPBACK}:{web}/{name}", server) for name in FILES}
        finally:
            server.kill()
            server.communicate()


def free_port():
    """Return a port of this machine that nobody uses at the moment."""
    with socket.create_server((LOOPBACK, 0)) as taken:
        return taken.getsockname()[1]


def _program():
    spec = find_spec("rerun_cli")
    if spec is None:
        raise NoViewer("this package of rerun-sdk contains no viewer")
    return Path(spec.origin).with_name("rerun")


def _fetched(address, server):
    opener, end = build_opener(ProxyHandler({})), time.monotonic() + _PATIENCE
    while True:
        try:
            with opener.open(address, timeout=_PATIENCE) as answer:
                return answer.read()
        except (URLError, OSError) as error:
            if server.poll() is not None:
                words = server.stderr.read().decode(errors="replace").strip().splitlines()
                raise NoViewer(
                    f"rerun ended with exit code {server.returncode}: {words[-1] if words else ''}"
                ) from None
            if time.monotonic() > end:
                raise NoViewer(f"rerun does not serve its viewer: {error}") from None
        time.sleep(0.05)
