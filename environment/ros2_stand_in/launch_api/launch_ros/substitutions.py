"""Places of packages."""

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from launch import LaunchError
from launch.substitutions import Substitution


class FindPackageShare(Substitution):
    """The folder of a package's own files."""

    def __init__(self, package):
        self._package = package

    def perform(self, context):
        """Return its path."""
        package = context.perform_substitution(self._package)
        try:
            return get_package_share_directory(package)
        except (PackageNotFoundError, ValueError):
            raise LaunchError(f"package '{package}' is not found") from None
