"""How pictures show the two sensors of the mounts, and the names of their axes."""

COLOURS = {"chassis": "#3b6ea5", "powertrain": "#d1662b"}
NAMES = ("longitudinal x", "lateral y", "vertical z")
LOWEST_FREQUENCY = 1.0  # Hz, where the spectrum starts
