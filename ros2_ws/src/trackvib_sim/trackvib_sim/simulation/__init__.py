"""One time step as a table of contents, runs, and the closed loop in one process. No ROS."""
