"""`./trackvib docs`: builds the documents' site, and shows it on this machine."""

import os
import signal
import sys
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
    command = [sys.executable, "-m", "mkdocs"]
    if folder is None:
        command += ["serve", "--dev-addr", f"127.0.0.1:{port}"]
    else:
        place = Path(folder).absolute()
        if place.exists():  # MkDocs would empty it
            raise click.ClickException(f"{folder!r} already exists; nothing is overwritten, choose another --build")
        command += ["build", "--site-dir", str(place)]
    # the theme's authors advertise their next generator on every start
    env = dict(os.environ, NO_MKDOCS_2_WARNING="1")
    os.execve(command[0], [*command, "--strict", "--config-file", str(ROOT / "mkdocs.yml")], env)


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # `| head` ends it quietly
    main(prog_name="trackvib docs")
