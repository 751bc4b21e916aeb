"""Studies: many runs of the whole vehicle, set beside published results. No ROS."""

from ..extras import require

require("studies", "cma", "cryptography", "distributed", "matplotlib", "rich")
