"""What stands between the body tree and the ground."""
