"""What of a user's settings decides from where pip gets packages."""

import re

_PROXIES = ("https_proxy", "HTTPS_PROXY", "http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY", "PIP_PROXY")
_INDEXES = ("PIP_INDEX_URL", "PIP_EXTRA_INDEX_URL", "PIP_FIND_LINKS", "PIP_NO_INDEX", "PIP_CONFIG_FILE")


def settings(environ) -> str:
    """One line that says that packages cannot be had, and which variables of `environ` to look at; no passwords."""
    found = [f"{name}={_public(environ[name])}" for name in (*_PROXIES, *_INDEXES) if environ.get(name)]
    what = (
        ", ".join(found) or "no proxy and no index of your own is set, so it is the network or pip's own configuration"
    )
    return f"pip cannot get the first package; look at: {what}"


def _public(value: str) -> str:
    """`value` in one line of plain characters, each address in it without user name and password."""
    addresses = [re.sub(r"//[^/]*@", "//", word) for word in value.split()]
    return ascii(" ".join(addresses))[1:-1]
