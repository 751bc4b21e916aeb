"""`./trackvib docs`: builds the documents' site, and shows it on this machine."""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import click

ROOT = Path(__file__).resolve().parents[1]


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--build", "folder", metavar="DIR", help="Only build the site, into a new folder.")
@click.option("--port", type=click.IntRange(1, 65535), default=8000, show_default=True, help="Where it is shown.")
def main(folder, port):
    """Build the documents as a site and show it on 127.0.0.1, anew after each change, until Ctrl-C.

    A broken link is an error.
    """
    settings = ["--strict", "--config-file", str(ROOT / "mkdocs.yml")]
    # the theme's authors advertise their next generator on every start
    env = dict(os.environ, NO_MKDOCS_2_WARNING="1")
    if folder is None:
        words = [sys.executable, "-m", "mkdocs", "serve", "--dev-addr", f"127.0.0.1:{port}", *settings]
        os.execve(words[0], words, env)
    place = Path(folder).absolute()
    if place.exists():
        raise click.ClickException(f"{folder!r} already exists; nothing is overwritten, choose another --build")
    place.parent.mkdir(parents=True, exist_ok=True)
    sys.exit(_build(place, settings, env))


def _build(place, settings, env):
    """Build the site, which takes its place when it is whole; returns the exit code."""
    with tempfile.TemporaryDirectory(prefix=".new_", dir=place.parent) as draft:
        site = Path(draft) / place.name
        words = [sys.executable, "-m", "mkdocs", "build", "--site-dir", str(site), *settings]
        try:
            code = subprocess.run(words, env=env).returncode
        except KeyboardInterrupt:
            print("interrupted; nothing is kept", file=sys.stderr)
            return 128 + signal.SIGINT
        if code == 0:
            site.rename(place)
    return code


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` ends it quietly
    main(prog_name="trackvib docs")
