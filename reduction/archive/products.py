"""Which files of a campaign's folder are reduced tests, and which names are taken."""

from __future__ import annotations

import os
from pathlib import Path

OF_CAMPAIGN = ("surfaces", "predictions", "comparisons", "outcomes", "change_in_length")
"""Archives of a whole campaign, by their file names; no test may be called so."""


def archives_in(folder: Path) -> list[Path]:
    """All archives in a folder, by name; `OSError` where the system refuses it."""
    try:
        names = os.listdir(folder)
    except (FileNotFoundError, NotADirectoryError):
        return []
    # a folder that may not be read is no empty one, as `Path.glob` has it
    return [folder / name for name in sorted(names) if name.endswith(".nc")]


def archives_of_tests(folder: Path) -> list[Path]:
    """Archives of reduced tests in a folder, by name; `OSError` where the system refuses it."""
    return [path for path in archives_in(folder) if path.stem not in OF_CAMPAIGN]
