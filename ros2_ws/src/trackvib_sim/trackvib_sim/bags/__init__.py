"""Bags: MCAP files in rosbag2's own layout, written, read as columns or message by message, completed, played.

| files | do |
|---|---|
| `unfolding`, `mcap_records`, `mcap_finder`, `mcap_messages`, `mcap_walk`, `mcap_summary` | the file format: bounds, one record, which records hold, messages as arrays, the one walk that all reading and repairing uses, the index |
| `files`, `metadata`, `qos`, `schemas`, `new_files` | a bag as a folder: its files, `metadata.yaml`, what its topics declare |
| `writing`, `copying`, `repair` | bags that are written: new, from another one, completed |
| `reading`, `columns`, `cdr_layout`, `recording`, `raw_messages`, `contents`, `playing` | bags that are read: as columns of numbers, as bytes, from the index, in order of time |
| `provenance`, `versions`, `timekeeping` | what made a bag, and the times of its messages |

A bag is not trusted: lengths, depths and sizes in it are checked before they are used, and what is damaged is named
with the way out. Nothing here knows a vehicle or a simulation, and nothing imports rclpy.
"""
