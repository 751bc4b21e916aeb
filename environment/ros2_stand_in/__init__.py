"""Stand-in for the `ros2` command where ROS 2 comes as Python wheels, which leave it out: on rclpy alone.

`arguments` has the verbs and what each takes; the other modules do them, in words and formats of ros2cli. They are
imported when they are asked for, so that help is quick.
"""
