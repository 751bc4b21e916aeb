"""The documents, and the program that renews what they take from the code, for the tests that hold them."""

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "docs"))  # where the program lies, which is no part of a package

import code_tables  # noqa: E402
import renew  # noqa: E402
import tutorial_pages  # noqa: E402

DOCUMENTS = [*renew.documents(), ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
__all__ = ["DOCUMENTS", "ROOT", "code_tables", "renew", "tutorial_pages"]
