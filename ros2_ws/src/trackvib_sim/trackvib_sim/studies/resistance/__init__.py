"""What it takes to roll on level ground, and where the heat goes."""
