"""Products that a campaign asks for, against those that are there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from reduction.archive.laboratory import FILE_NAME, read_details
from reduction.archive.products import OF_CAMPAIGN
from reduction.batch.asked import parts_asked
from reduction.batch.lock import LOCK_NAME
from reduction.batch.status import TestStatus
from reduction.campaign.plan import Campaign
from reduction.errors import ArchiveError
from reduction.verify.archives import Looked
from reduction.verify.finding import Finding

__all__ = ["details_findings", "missing_or_stray", "status_findings", "tests_of", "unfinished"]

_AGAIN = "Run the campaign again."


def tests_of(campaign: Campaign) -> list[str]:
    """Ids of the products of tests and steps, in the order of the campaign."""
    return [
        product
        for plan in campaign.tests.values()
        for product in ([step.product(plan.id) for step in plan.steps] or [plan.id])
    ]


def missing_or_stray(
    campaign: Campaign, archives: Mapping[str, Looked], status: Mapping[str, TestStatus]
) -> Iterator[Finding]:
    """Archives that the campaign asks for and that are not there, and the other way round.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    archives : mapping of str to Looked
        By the names of tests and parts.
    status : mapping of str to TestStatus
        Of the last run, by test.

    Yields
    ------
    finding : Finding
        One an archive.
    """
    tests = tests_of(campaign)
    for name in tests:
        if name not in archives:
            row = status.get(name)
            why = row.message if row is not None and row.status == "failed" else ""
            yield Finding(f"{name}.nc", "missing", "there is no archive of this test", why)
    asked = parts_asked(campaign)
    for name in OF_CAMPAIGN:
        if name in asked and name not in archives:
            yield Finding(f"{name}.nc", "missing", "the campaign asks for it", hint=_AGAIN)
    known = {*tests, *asked, "change_in_length"}
    for name, looked in archives.items():
        if name not in known and not looked.findings:
            yield Finding(
                looked.path.name, "stray", "campaign.toml has nothing that it could be made from",
                hint="Remove it, or put back into campaign.toml what it is of.",
            )  # fmt: skip


def details_findings(campaign: Campaign, folder: Path) -> Iterator[Finding]:
    """What the laboratory states for its client, kept beside the archives, against the campaign."""
    try:
        kept = read_details(folder)
    except ArchiveError as error:
        yield Finding(FILE_NAME, "damaged", "it cannot be read", error.found or "", hint=_AGAIN)
        return
    if kept != campaign.report:
        problem = "it is not what [report] of campaign.toml says"
        yield Finding(FILE_NAME, "settings", problem, hint=_AGAIN)


def status_findings(
    archives: Mapping[str, Looked], status: Mapping[str, TestStatus]
) -> Iterator[Finding]:
    """Rows of status.csv that speak of other logs than the archives were made from.

    Parameters
    ----------
    archives : mapping of str to Looked
        By the names of tests and parts.
    status : mapping of str to TestStatus
        Of the last run, by test.

    Yields
    ------
    finding : Finding
        One a test.
    """
    tests: Sequence[str] = [name for name in archives if name not in OF_CAMPAIGN]
    if tests and not status:
        yield Finding("status.csv", "missing", "it is not there or cannot be read", hint=_AGAIN)
        return
    for name in tests:
        row, looked = status.get(name), archives[name]
        if looked.findings:
            continue
        sums = " ".join(source.sha256 for source in looked.sources)
        if row is None:
            yield Finding("status.csv", "status", f"it has no row of {name}", hint=_AGAIN)
        elif row.status != "failed" and row.raw_sha256 != sums:
            yield Finding(
                "status.csv", "status", f"its row of {name} is of another log than the archive",
                f"sha256 {row.raw_sha256[:16]}...", f"{sums[:16]}...", _AGAIN,
            )  # fmt: skip


def unfinished(folder: Path) -> Iterator[Finding]:
    """What a run that is at work, or that was killed, has left in the folder."""
    if (folder / LOCK_NAME).exists():
        yield Finding(
            LOCK_NAME, "unfinished", "a run is at work here, or was killed",
            hint="Wait until it has ended; after one that was killed, run the campaign again.",
        )  # fmt: skip
    for part in sorted(folder.rglob(".*.part")):
        yield Finding(
            part.relative_to(folder).as_posix(), "unfinished",
            "a file that was begun and not ended",
            hint="Products are as they were; the next run takes it away.",
        )  # fmt: skip
