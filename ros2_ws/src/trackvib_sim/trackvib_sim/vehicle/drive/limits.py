"""What can be asked of a driver; no more than numbers, for those who must not wait for kernels."""

FASTEST = 25.0  # m/s either way, what running gear and contacts are made for
