"""What colcon and ROS 2 need beside pyproject.toml."""

from xml.etree import ElementTree

from setuptools import find_packages, setup

name = "mr_mount_controller"

setup(
    version=ElementTree.parse("package.xml").findtext("version"),
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(exclude=["test*"]),
    package_data={name: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{name}"]),
        # colcon builds from links to what is listed here, and finds no other pyproject.toml
        (f"share/{name}", ["package.xml", "pyproject.toml"]),
    ],
)
