from setuptools import find_packages, setup

name = "mr_mount_controller"

setup(
    name=name,
    version="0.1.0",
    description="Controller node for magnetorheological powertrain mounts.",
    license="Apache-2.0",
    maintainer="trackvib developers",
    maintainer_email="developers@trackvib.invalid",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{name}"]),
        (f"share/{name}", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy"],
    extras_require={"test": ["pytest"]},
    zip_safe=True,
    entry_points={
        "console_scripts": [f"controller = {name}.node:main"],
        # users' packages add their laws to this group
        f"{name}.laws": [
            f"passive = {name}.laws.passive:Passive",
            f"skyhook = {name}.laws.skyhook:Skyhook",
        ],
    },
)
