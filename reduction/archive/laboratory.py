"""``report.json`` beside the archives: what the laboratory states for its client.

It stands apart from the archives: no number depends on it, so that a report can be amended while
every archive stays what it was.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from reduction.archive.whole import take_away
from reduction.archive.write import write_whole
from reduction.errors import ArchiveError
from reduction.laboratory import ReportDetails

__all__ = ["FILE_NAME", "keep_details", "read_details"]

FILE_NAME = "report.json"


def keep_details(folder: Path, details: ReportDetails | None) -> None:
    """Write what the laboratory states, or take away what an earlier run kept.

    Parameters
    ----------
    folder : pathlib.Path
        Of the archives of a campaign.
    details : ReportDetails or None
        None where the campaign has no ``[report]``.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    path = folder / FILE_NAME
    if details is None:
        take_away(path)
        return
    write_whole(path, json.dumps(asdict(details), indent=1, ensure_ascii=False) + "\n")


def read_details(folder: Path) -> ReportDetails | None:
    """Read what the laboratory states.

    Parameters
    ----------
    folder : pathlib.Path
        Of the archives of a campaign.

    Returns
    -------
    details : ReportDetails or None
        None where nothing was kept.

    Raises
    ------
    ArchiveError
        If the file cannot be read.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        return None
    try:
        return TypeAdapter(ReportDetails).validate_json(path.read_bytes())
    except (OSError, ValidationError) as error:
        raise ArchiveError(
            f"{path} cannot be read",
            found=str(error).splitlines()[0],
            needed="what a run keeps of [report]",
            hint="Run the campaign again.",
        ) from error
