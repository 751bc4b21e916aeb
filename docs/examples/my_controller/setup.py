from setuptools import setup

setup(
    name="my_controller",
    version="0.1.0",
    packages=["my_controller"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/my_controller"]),
        ("share/my_controller", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    entry_points={
        # ros2 run my_controller own_node
        "console_scripts": ["own_node = my_controller.own_node:main"],
        # law:=busy_firm on the stock node, --law busy_firm in a whole run
        "mr_mount_controller.laws": ["busy_firm = my_controller.busy_firm:BusyFirm"],
    },
)
