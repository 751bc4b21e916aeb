"""What a bare installation lacks, said by the name of the extra that brings it."""

from importlib.util import find_spec


def require(extra, *packages):
    """Make sure that some packages are there.

    Raises
    ------
    ImportError
        One is not; the message tells which extra of this package to install.
    """
    missing = [package for package in packages if find_spec(package) is None]
    if missing:
        raise ImportError(
            f'{", ".join(missing)} not installed; pip install "trackvib_sim[{extra}]" brings what is needed'
        )
