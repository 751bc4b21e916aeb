"""The vehicle and its road as shapes in places: one description for the viewer, for ROS's frames and for pictures."""
