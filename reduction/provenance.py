"""Where a product came from and what was done to it, as frozen values.

No clock and no file access here: hashes are taken in `reduction.ingest`, times
come in from the command line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


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


@dataclass(frozen=True)
class Origin:
    """Where an archive that several tests or files go into came from, and how it was made.

    Parameters
    ----------
    campaign_id : str
        Of the campaign.
    attributes : mapping of str to str
        What the laboratory said of the campaign.
    sources : sequence of Source
        The files that it was made from.
    steps : sequence of Step
        History lines.
    settings_json : str
        Every setting that was in force, and every number that was given.
    version : str
        Version of this software.
    command : str
        What the user asked for, without paths, jobs and scheduler.
    """

    campaign_id: str
    attributes: Mapping[str, str]
    sources: Sequence[Source]
    steps: Sequence[Step]
    settings_json: str
    version: str
    command: str
