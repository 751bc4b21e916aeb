"""The loop as an environment of Gymnasium: importing this registers `trackvib/Mounts-v0` (docs/learning.md)."""

from ..extras import require

require("gym", "gymnasium")

import gymnasium  # noqa: E402

gymnasium.register("trackvib/Mounts-v0", entry_point=f"{__name__}.mounts_env:MountsEnv", max_episode_steps=10_000)
