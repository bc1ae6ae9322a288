"""Outcomes without a log: the rows of a campaign's table of results, made complete."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from reduction.campaign.results import read_results
from reduction.errors import LogError
from reduction.ingest.source import hash_source, unchanged
from reduction.outcomes.groups import complete_from_specimens
from reduction.outcomes.product import Outcome
from reduction.provenance import Source
from reduction.record import Specimen


def outcomes_of(
    path: Path, name: str, specimens: Mapping[str, Specimen]
) -> tuple[Source | None, tuple[Outcome, ...]]:
    """Read the table of results of a campaign.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    name : str
        The table, in its folder; empty where there is none.
    specimens : mapping of str to Specimen
        Sheets, for what a row leaves open.

    Returns
    -------
    source : Source or None
        The table with the hash of what was read.
    outcomes : tuple of Outcome
        Its rows, made complete.

    Raises
    ------
    LogError
        If the table cannot be used, or a row names an unknown specimen.
    """
    if not name:
        return None, ()
    table = path.parent / name
    with unchanged(table):
        source = hash_source(table, name)
        rows = read_results(table)
    for row in rows:
        if row.specimen and row.specimen not in specimens:
            raise LogError(
                table, "an outcome names an unknown specimen", row=row.row, channel="specimen",
                found=repr(row.specimen),
                needed="one of " + ", ".join(specimens) if specimens else "[specimens.NAME]",
                hint="A name without a sheet, of a break or a test, stands in id.",
            )  # fmt: skip
    return source, complete_from_specimens(rows, specimens)
