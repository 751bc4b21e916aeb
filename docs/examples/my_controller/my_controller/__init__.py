"""Example of a controller of one's own."""
