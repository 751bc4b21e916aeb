"""What the verbs of the command line do; options are checked here, the work lies in the packages below."""

from ..extras import require

require("report", "click", "matplotlib", "pyarrow", "rich")
