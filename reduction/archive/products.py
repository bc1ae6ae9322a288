"""Which files of a campaign's folder are reduced tests, and which names are taken."""

from __future__ import annotations

from pathlib import Path

__all__ = ["OF_CAMPAIGN", "archives_of_tests"]

OF_CAMPAIGN = ("surfaces", "predictions", "comparisons", "outcomes", "change_in_length")
"""Archives of a whole campaign, by their file names; no test may be called so."""


def archives_of_tests(folder: Path) -> list[Path]:
    """Archives of reduced tests in a folder, by name."""
    return sorted(path for path in folder.glob("*.nc") if path.stem not in OF_CAMPAIGN)
