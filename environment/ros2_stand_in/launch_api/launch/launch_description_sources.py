"""Launch files that `launch.actions.IncludeLaunchDescription` takes."""

from launch import load_description


class PythonLaunchDescriptionSource:
    """One in Python, by its path."""

    def __init__(self, launch_file_path):
        self._path = launch_file_path

    def load(self, context):
        """Return its description."""
        return load_description(context.perform_substitution(self._path))
