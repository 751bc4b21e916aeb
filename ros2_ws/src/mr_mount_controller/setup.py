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
    install_requires=["setuptools", "numpy", "scipy"],
    extras_require={"test": ["pytest"]},
    zip_safe=True,
    entry_points={
        "console_scripts": [f"controller = {name}.node:main"],
        # users' packages add their laws to this group
        f"{name}.laws": [
            f"passive = {name}.laws.passive:Passive",
            f"skyhook = {name}.laws.skyhook:Skyhook",
            f"continuous_skyhook = {name}.laws.hybrid:ContinuousSkyhook",
            f"groundhook = {name}.laws.hybrid:Groundhook",
            f"hybrid = {name}.laws.hybrid:Hybrid",
            f"acceleration_driven = {name}.laws.acceleration_driven:AccelerationDriven",
            f"mixed_skyhook_add = {name}.laws.acceleration_driven:MixedSkyhookAdd",
            f"clipped_optimal = {name}.laws.clipped_optimal:ClippedOptimal",
            f"engine_order = {name}.laws.engine_order:EngineOrder",
        ],
    },
)
