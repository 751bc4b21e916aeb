"""A recorded run to look at: in Rerun's viewer, or as an animated picture."""

import os

from ..extras import require

require("report", "matplotlib")
os.environ["RERUN_ANALYTICS"] = "off"  # before Rerun is imported: it reports home otherwise
