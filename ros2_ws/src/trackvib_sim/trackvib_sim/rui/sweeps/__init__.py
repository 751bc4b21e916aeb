"""The production form, compiled: cells and lanes, kinematics, the two sweeps of the Riccati form, integration."""
