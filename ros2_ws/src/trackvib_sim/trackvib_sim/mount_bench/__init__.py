"""A test bench for mounts: what a mount does when it is shaken, and a mount's parameters from measured loops."""

LAWS = ("viscoelastic", "yielding")  # that can be fitted
