"""Values of one table of TOML in SI; an error names the file and the key."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Strict

from reduction.campaign.faults import in_toml
from reduction.errors import SettingsError
from reduction.units import Dimension, parse_quantity

Number = str | Annotated[float, Strict()]
"""A number of TOML or text with a unit; true and false are neither."""
_GREATEST = 1e15


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
            value = parse_quantity(text, dimension)
            if not abs(value) < _GREATEST:
                raise SettingsError(
                    "a number is beyond anything physical", found=str(text), needed="a finite one"
                )
            return value
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
