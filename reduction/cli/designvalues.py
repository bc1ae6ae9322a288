"""The design-value page after a run or a report."""

from __future__ import annotations

from pathlib import Path

from reduction.cli.commandoutput import CommandOutput
from reduction.designpage.page import write_design_page

__all__ = ["refresh_design_page"]


def refresh_design_page(processed: Path, reports: Path, output: CommandOutput) -> str | None:
    """Write the design-value page of a folder of products again, and say where it is.

    Parameters
    ----------
    processed : pathlib.Path
        Folder in which campaigns have theirs.
    reports : pathlib.Path
        Folder of the page.
    output : CommandOutput
        Knows which folders are copies of what is on the net.

    Returns
    -------
    path : str or None
        None where one of the folders is a copy: it holds one campaign, and its page would take
        the place of one of many.
    """
    if any(str(folder) in output.names for folder in (processed, reports)):
        return None
    path = str(write_design_page(processed, reports))
    output.say(f"values:   {path}")
    return path
