"""The part of ROS 2's `launch_ros` that launch files of nodes use, under the same names."""
