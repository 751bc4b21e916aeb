"""Bags: MCAP files in rosbag2's own layout, and what is read out of them. No rclpy."""
