"""Where everything lies in a checkout."""

from pathlib import Path


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
        self.kernels = self.home / "kernels"
