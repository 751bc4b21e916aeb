"""From recorded accelerations to numbers and pictures. No ROS."""
