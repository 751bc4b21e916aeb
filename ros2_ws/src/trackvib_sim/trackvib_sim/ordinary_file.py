"""Opens files from outside: ordinary ones only, for a device has no end and a pipe may never begin."""

import errno
import os
from stat import S_ISREG


def open_ordinary(path, largest):
    """Return an ordinary file of at most `largest` bytes, open for the reading of bytes.

    Raises
    ------
    OSError
        It cannot be opened, is a folder, a device or a pipe, or too large; `strerror` says which.
    """
    try:
        # a pipe that nobody writes to must not hold us up
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except ValueError as error:  # a name with NUL in it, or that is no text
        raise OSError(errno.EINVAL, str(error)) from None
    told = os.fstat(descriptor)
    if S_ISREG(told.st_mode) and told.st_size <= largest:
        return open(descriptor, "rb")
    os.close(descriptor)
    if not S_ISREG(told.st_mode):
        raise OSError(errno.EINVAL, "it is not a regular file")
    raise OSError(errno.EFBIG, f"it has {told.st_size} bytes, accepted: {largest}")
