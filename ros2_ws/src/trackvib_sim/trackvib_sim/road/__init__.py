"""Road profiles. No vehicle, no ROS."""
