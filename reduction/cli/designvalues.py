"""The design-value page after a run or a report."""

from __future__ import annotations

from pathlib import Path

from reduction.archive.open import Opener, reading
from reduction.cli.commandoutput import CommandOutput
from reduction.designpage.page import PAGE_NAME, write_design_page
from reduction.errors import ArchiveError


def address_of_design_page(processed: Path, reports: Path, output: CommandOutput) -> str:
    """Address of the design-value page from the folder of a report; empty where none is written."""
    return "" if _is_copy(processed, reports, output) else f"../{PAGE_NAME}"


def refresh_design_page(
    processed: Path,
    reports: Path,
    output: CommandOutput,
    *,
    made: str = "",
    opener: Opener = reading,
) -> str | None:
    """Write the design-value page of a folder of products again, and say where it is.

    Parameters
    ----------
    processed : pathlib.Path
        Folder in which campaigns have theirs.
    reports : pathlib.Path
        Folder of the page.
    output : CommandOutput
        Knows which folders are copies of what is on the net.
    made : str
        Campaign that was just reduced: where an archive of it cannot be read the page is left as
        it was. One of others is left out, which is said here and on the page.
    opener : Opener
        How archives are opened.

    Returns
    -------
    path : str or None
        None where one of the folders is a copy: it holds one campaign, and its page would take
        the place of one of many.

    Raises
    ------
    ArchiveError
        If the page cannot be written, or would lack what was just made.
    """
    if _is_copy(processed, reports, output):
        return None
    left_out: dict[Path, str] = {}

    def unreadable(archive: Path, why: str) -> None:
        if archive.parent.name == made:
            raise ArchiveError(
                f"{archive} cannot be read, and the page of design values is left as it was",
                found=why.removesuffix("."),
                hint="Check the disk, and run again.",
            )
        left_out[archive] = why

    path = str(write_design_page(processed, reports, unreadable=unreadable, opener=opener))
    for archive, why in left_out.items():
        output.error(f"{archive} is not on the page of design values: {why}")
    output.say(f"design values: {path}")
    return path


def _is_copy(processed: Path, reports: Path, output: CommandOutput) -> bool:
    return any(str(folder) in output.names for folder in (processed, reports))
