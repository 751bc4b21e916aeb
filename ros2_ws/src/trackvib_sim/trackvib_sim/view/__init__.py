"""A recorded run to look at: in Rerun's viewer, or as an animated picture."""

from ..extras import require

require("report", "matplotlib")
