"""Drawings of the vehicle to scale, of its tree and of its modes, and the table of its parameters."""

from ..extras import require

require("report", "matplotlib")
