"""The namespace that holds all nodes of one vehicle."""

import re

from mr_mount_controller.node_base.parameters import ParameterError

_TOKEN = "[A-Za-z_][A-Za-z0-9_]*"
_NAMESPACE = re.compile(f"/?({_TOKEN}(/{_TOKEN})*)?")
_LONGEST = 100  # characters; topics and services in it have names of 255 at most


def full_namespace(name):
    """Return a namespace with a slash in front; "/" for none.

    Raises
    ------
    ParameterError
        ROS 2 takes no such name.
    """
    if not _NAMESPACE.fullmatch(name) or len(name) > _LONGEST:
        raise ParameterError(
            f"namespace is {name!r}, accepted: at most {_LONGEST} letters, digits and _, in parts "
            "separated by slashes that do not begin with a digit"
        )
    return f"/{name.lstrip('/')}"
