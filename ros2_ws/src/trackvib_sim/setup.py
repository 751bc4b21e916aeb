from glob import glob

from setuptools import find_packages, setup

name = "trackvib_sim"

setup(
    name=name,
    version="0.1.0",
    description="Closed-loop vibration laboratory for tracked vehicles: simulator, road, recorder, command line.",
    license="Apache-2.0",
    maintainer="trackvib developers",
    maintainer_email="developers@trackvib.invalid",
    packages=find_packages(exclude=["test"]),
    package_data={f"{name}.analysis.report": ["templates/*"], f"{name}.data": ["*.yaml", "*.csv"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{name}"]),
        (f"share/{name}", ["package.xml"]),
        (f"share/{name}/config", glob("config/*.yaml")),
        (f"share/{name}/launch", glob("launch/*.launch.py")),
    ],
    install_requires=[
        "setuptools",
        "click",
        "cma",
        "distributed",
        "jinja2",
        "matplotlib",
        "mcap",
        "numba",
        "numpy",
        "pin",
        "plotly",
        "pyarrow",
        "pydantic>=2",
        "pyyaml",
        "rich",
        "rosbags",
        "scipy",
        "zstandard",
    ],
    extras_require={"test": ["html5lib", "hypothesis", "mcap-ros2-support", "pytest", "selenium"]},
    zip_safe=True,
    entry_points={
        "console_scripts": [
            f"one_process = {name}.nodes.one_process:main",
            f"simulator = {name}.nodes.simulator:main",
            f"player = {name}.nodes.player:main",
            f"road_excitation = {name}.nodes.road_excitation:main",
            f"recorder = {name}.nodes.recorder:main",
        ],
    },
)
