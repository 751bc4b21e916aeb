"""Controller of magnetorheological powertrain mounts. Knows accelerations and currents, not the simulator."""
