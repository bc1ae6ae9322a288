"""Lists the archives in a folder of products."""

from __future__ import annotations

import csv
import io
import os
from contextlib import suppress
from pathlib import Path

from reduction.archive.atomic_write import atomic_file
from reduction.record.errors import ArchiveError
from reduction.record.plain_text import bare_cell

OF_CAMPAIGN = ("surfaces", "predictions", "comparisons", "outcomes", "change_in_length")
"""Archives of a whole campaign by file name, which no test may have."""

SUPERSEDED = "superseded"
"""Folder beside the archives of a campaign for those that it no longer makes."""

STATUS_NAME = "status.csv"
"""File that every run leaves beside its archives."""

CLIENT_PAGE_NAME = "client-report.html"
"""Report to a client, beside the page of a campaign."""

DESIGN_PAGE_NAME = "design-values.html"
"""Page of design values, beside the folders of the reports."""


CAMPAIGN_PLACE = ".campaign"
"""File beside the archives of a campaign with the location of the last campaign.toml."""


def campaign_of(folder: Path) -> Path | None:
    """Location of the campaign.toml for a folder of archives; None if it is not recorded."""
    try:
        text = (folder / CAMPAIGN_PLACE).read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        return None
    # relative to the folder, so that both can be moved together
    return Path(os.path.normpath(folder.absolute() / text)) if text else None


def record_campaign(folder: Path, campaign: Path) -> Path | None:
    """Record in a folder of archives which campaign.toml made them.

    Returns the campaign whose results were there, if it is another one that still exists.
    """
    try:
        place = os.path.relpath(campaign.absolute(), folder.absolute())
    except ValueError:  # another drive
        place = str(campaign.absolute())
    earlier = campaign_of(folder)
    if earlier == Path(os.path.normpath(folder.absolute() / place)):
        return None
    # optional: the campaign is also found in its usual place
    with suppress(OSError), atomic_file(folder / CAMPAIGN_PLACE) as begun:
        begun.write_text(Path(place).as_posix() + "\n", encoding="utf-8")
    # a campaign that was moved, or is named by another path, is the same one
    is_other = earlier is not None and earlier.is_file() and not earlier.samefile(campaign)
    return earlier if is_other else None


def earlier_run_words(archive: Path) -> tuple[str, ...]:
    """Why an archive is not from the last run of the campaign in its folder; empty if it is."""
    name, test = archive.stem, archive.stem.partition(".")[0]
    if archive.parent.name == SUPERSEDED:
        return (f"{name} is from an earlier run: the campaign no longer makes it",)
    try:
        text = (archive.parent / STATUS_NAME).read_text(encoding="utf-8")
        is_listed = name in OF_CAMPAIGN or f"\n{name}," in text
        if is_listed and "failed" not in text:  # of a thousand archives, not a thousand tables
            return ()
        rows = {row["test"]: row for row in csv.DictReader(io.StringIO(text, newline=""))}
    except (OSError, KeyError, ValueError, csv.Error):
        return ()  # an archive without its campaign
    # of a log that could not be read, the archives of its steps are kept
    failed = [rows[one] for one in dict.fromkeys((name, test))
              if one in rows and rows[one]["status"] == "failed"]  # fmt: skip
    if not failed and name not in rows and name not in OF_CAMPAIGN:
        return (
            f"{name} has no row in {STATUS_NAME}: it is of a test that the campaign no longer has,"
            " of another campaign, or of a run that did not finish. Run the campaign again",
        )
    return tuple(
        f"{name} could not be reduced in the last run, and its archive is from an earlier one:"
        f" {bare_cell(row['message'] or '')}"
        for row in failed
    )


def archives_in(folder: Path) -> list[Path]:
    """All archives in a folder by name; `OSError` if the system refuses it."""
    try:
        names = os.listdir(folder)
    except (FileNotFoundError, NotADirectoryError):
        return []
    # unlike with `Path.glob`, an unreadable folder does not count as empty
    return [folder / name for name in sorted(names) if name.endswith(".nc")]


def processed_folders(processed: Path) -> list[Path]:
    """Folders with archives: the given one, or those inside it."""
    inside = sorted(processed.iterdir()) if processed.is_dir() else []
    folders = [processed] if archives_in(processed) else [one for one in inside if one.is_dir()]
    folders = [folder for folder in folders if archives_in(folder)]
    if not folders:
        raise ArchiveError(
            f"{processed}: no archive was found",
            needed="a folder processed/CAMPAIGN with *.nc in it",
            hint="`reduction run CAMPAIGN.toml` makes one.",
        )
    return folders


def archives_of_tests(folder: Path) -> list[Path]:
    """Archives of reduced tests in a folder by name; `OSError` if the system refuses it."""
    return [path for path in archives_in(folder) if path.stem not in OF_CAMPAIGN]
