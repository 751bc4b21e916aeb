"""Studies: many runs of the whole vehicle, set beside published results. No ROS."""
