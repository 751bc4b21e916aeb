"""Vibration laboratory for tracked vehicles, as a library: what it offers stands in `__init__.pyi`, a page by drawers.

Names are imported when they are first asked for, so that a node starts without what it does not use. None needs ROS 2.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
