"""What colcon and ROS 2 need beside pyproject.toml."""

from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

name = "trackvib_sim"

setup(
    version=ElementTree.parse("package.xml").findtext("version"),
    license="Apache-2.0",
    python_requires=">=3.10",
    packages=find_packages(exclude=["test*"]),
    package_data={
        name: [
            "py.typed",
            "*.pyi",
            "rui/*.pyi",
            "analysis/report/templates/*",
            "view/page/*",
            "data/**/*.yaml",
            "data/**/*.csv",
            "data/**/*.gz",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{name}"]),
        # colcon builds from links to what is listed here, and finds no other pyproject.toml
        (f"share/{name}", ["package.xml", "pyproject.toml"]),
        (f"share/{name}/config", glob("config/*.yaml")),
        (f"share/{name}/layouts", glob("layouts/*")),
        (f"share/{name}/launch", glob("launch/*.launch.py")),
    ],
)
