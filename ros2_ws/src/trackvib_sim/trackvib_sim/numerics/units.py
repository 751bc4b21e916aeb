"""Units that are not SI's own, in SI units."""

from math import pi

NANO = 1_000_000_000  # ns in a second
RPM = 2.0 * pi / 60.0  # rad/s in a revolution a minute
