"""Closed-loop vibration laboratory for a tracked vehicle's powertrain on magnetorheological mounts."""
