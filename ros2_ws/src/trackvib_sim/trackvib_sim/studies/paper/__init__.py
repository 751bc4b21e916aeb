"""`study table1` and `study figures`: the paper's table and figures, and the second solver."""
