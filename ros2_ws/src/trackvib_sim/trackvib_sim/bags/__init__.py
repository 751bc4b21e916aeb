"""Bags: MCAP files in rosbag2's own layout, written, read, copied, completed, played.

The file format
    limits, unfolding (of chunks), mcap_records (one record), mcap_finder (which records hold), mcap_messages
    (messages as arrays), mcap_walk (the one walk that all reading and repairing uses), mcap_summary (the index).
A bag as a folder
    files, metadata, qos, schemas.
Bags that are written
    writing (new), copying (from another one), repair (completed); provenance, versions, timekeeping.
Bags that are read
    reading, known_topics, columns, cdr_layout, mounting_of_bag, recording (as columns of numbers), raw_messages (as
    bytes), contents (from the index), playing (in order of time).
Bags of others
    sources (which sensors there are), accelerations, places, transforms, csv_recording.

A bag is not trusted: lengths, depths and sizes in it are checked before they are used, and what is damaged is named
with the way out. Nothing here knows a vehicle or a simulation, and nothing imports rclpy.
"""
