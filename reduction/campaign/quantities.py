"""Values of one table of TOML in SI; an error names the file and the key."""

from __future__ import annotations

from pathlib import Path

from reduction.campaign.faults import in_toml
from reduction.errors import SettingsError
from reduction.units import Dimension, parse_quantity

__all__ = ["Number", "TableReader"]

Number = str | float


class TableReader:
    """Values of one table; an error names the file and the key.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    place : str
        Of the table in it.
    """

    def __init__(self, path: Path, place: str) -> None:
        self.path, self.place = path, place

    def value(self, key: str, text: Number, dimension: Dimension) -> float:
        """Value in SI of what stands under a key."""
        try:
            return parse_quantity(text, dimension)
        except SettingsError as error:
            raise self.fault(f"{key}: {error.problem}", error) from error

    def optional(self, key: str, text: Number | None, dimension: Dimension) -> float | None:
        """Value in SI, None where nothing stands there."""
        return None if text is None else self.value(key, text, dimension)

    def fault(self, problem: str, error: SettingsError) -> SettingsError:
        """The same error with file and key in front."""
        return in_toml(
            self.path, f"{self.place}.{problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        )  # fmt: skip
