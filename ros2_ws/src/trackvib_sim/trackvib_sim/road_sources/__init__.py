"""Roads by name or file, and what a road is like: class, roughness index, level."""
