"""Where a product came from and what was done to it, as frozen values.

No clock and no file access here: hashes are taken in `reduction.ingest`, times
come in from the command line.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Source", "Step"]


@dataclass(frozen=True)
class Source:
    """One raw file.

    Parameters
    ----------
    name : str
        File name relative to the campaign folder.
    sha256 : str
        Hash of its bytes, hexadecimal.
    size : int
        Number of bytes.
    """

    name: str
    sha256: str
    size: int


@dataclass(frozen=True)
class Step:
    """One stage that has returned, with what it used.

    Parameters
    ----------
    name : str
        The stage, as the folder is called.
    text : str
        What it did, with the numbers it found or was given.
    """

    name: str
    text: str

    def line(self, version: str) -> str:
        """One line of the netCDF ``history`` attribute; no clock in it."""
        return f"reduction {version} {self.name}: {self.text}"
