"""`study calibrate`: uncertain parameters of the vehicle fitted to the given rows of the paper's table."""
