"""Where everything lies in a checkout, and what it is set up for."""

from pathlib import Path
from typing import NamedTuple

from environment.ros import Ros
from environment.system import Interpreter


class Places:
    """Paths of one checkout. All that the set-up makes lies under `home` and may be deleted at any time."""

    def __init__(self, root: Path):
        self.root = root
        self.sources = root / "ros2_ws" / "src"
        self.environment = root / "environment"
        self.starter = self.environment / "start_module.py"
        self.home = root / ".trackvib"
        self.interfaces = (self.environment / "tf2_msgs", self.environment / "simulation_interfaces")
        self.lock = self.home / "lock"
        self.logs = self.home / "log"
        self.venv = self.home / "venv"
        self.packages = self.venv / "packages"
        self.python = self.venv / "bin" / "python3"
        self.workspace = self.home / "workspace"
        self.modules = self.workspace / "modules"
        self.kernels = self.home / "kernels"


class Setup(NamedTuple):
    """What the environment is made for."""

    places: Places
    ros: Ros
    python: Interpreter

    @property
    def lock_file(self) -> Path:
        """All packages, pinned, for this kind of machine."""
        name = "requirements-own-ros.lock" if self.ros.prefix else "requirements.lock"
        return self.places.environment / name
