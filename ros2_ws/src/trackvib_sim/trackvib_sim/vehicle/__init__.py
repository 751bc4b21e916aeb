"""This vehicle: its parameters, its body tree and every force that acts on it. No ROS."""
