"""Where installed files lie."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory


def share():
    """Return the folder with this package's data files."""
    return Path(get_package_share_directory("trackvib_sim"))


def default_vehicle_file():
    """Return the path of the vehicle that comes with the package."""
    return share() / "config" / "vehicle.yaml"


def closed_loop_parameters():
    """Return the path of the node parameters that `closed_loop.launch.py` and `trackvib run` share."""
    return share() / "config" / "closed_loop.yaml"


def paper_table_file():
    """Return the path of the part of [Tao2025]'s Table 1 that the studies compare with."""
    return share() / "config" / "reference" / "table1_part.csv"


def calibration_plan_file():
    """Return the path of the calibration plan that comes with the package."""
    return share() / "config" / "calibration.yaml"
