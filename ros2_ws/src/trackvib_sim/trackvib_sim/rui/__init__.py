"""The Rui method (transfer matrix method for multibody systems). Knows no vehicle and no ROS."""
