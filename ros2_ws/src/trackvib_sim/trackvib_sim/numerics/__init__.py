"""The ground floor: how kernels are compiled, spatial algebra, units. It imports nothing of the house."""
