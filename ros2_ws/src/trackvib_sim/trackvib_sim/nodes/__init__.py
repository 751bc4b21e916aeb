"""The nodes: the only place here that imports rclpy."""
