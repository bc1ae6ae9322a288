"""All products of a campaign against its raw files, and against each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

from reduction.archive.products import OF_CAMPAIGN, archives_in
from reduction.batch.asked import products_asked
from reduction.batch.progress import Progress
from reduction.batch.status import read_status
from reduction.campaign.plan import Campaign
from reduction.verify.archives import Looked, look_at, misplaced
from reduction.verify.expected import (
    details_findings,
    missing_or_stray,
    status_findings,
    tests_of,
    unfinished,
)
from reduction.verify.finding import Finding, Verification
from reduction.verify.settings import settings_findings
from reduction.verify.sources import SourceCheck
from reduction.verify.tables import check_tables

__all__ = ["look_at_all", "stated_campaign", "verify_campaign"]


def look_at_all(folder: Path, *, progress: Progress) -> dict[str, Looked]:
    """Read every archive of a folder whole.

    Parameters
    ----------
    folder : pathlib.Path
        ``processed/CAMPAIGN``.
    progress : Progress
        Told of each archive.

    Returns
    -------
    archives : dict of str to Looked
        By the names of tests and parts.

    Raises
    ------
    OSError
        If the folder cannot be looked into.
    """
    paths = archives_in(folder)
    progress.stage("verify archives", len(paths))
    archives = {}
    for path in paths:
        archives[path.stem] = look_at(path)
        progress.ended(path.stem)
    return archives


def stated_campaign(archives: Iterable[Looked]) -> str:
    """Campaign that most archives are of, so that one in the wrong place does not decide.

    Parameters
    ----------
    archives : iterable of Looked
        Of one folder.

    Returns
    -------
    name : str
        Its id; empty where no archive can be read.
    """
    names = Counter(one.attributes.get("campaign", "") for one in archives if one.attributes)
    return names.most_common(1)[0][0] if names else ""


def verify_campaign(
    folder: Path,
    archives: Mapping[str, Looked],
    campaign: Campaign | None,
    *,
    unknown: str = "",
    progress: Progress,
) -> Verification:
    """Look whether the products of a campaign belong to its raw files and to each other.

    Nothing is written or changed but in a folder for temporary files.

    Parameters
    ----------
    folder : pathlib.Path
        ``processed/CAMPAIGN``.
    archives : mapping of str to Looked
        All of it, from `look_at_all`; findings are added to them.
    campaign : Campaign or None
        What the products were made from; None where it cannot be had.
    unknown : str
        Why it cannot.
    progress : Progress
        Told how far it is.

    Returns
    -------
    verification : Verification
        Without a finding where everything belongs together.
    """
    name = campaign.id if campaign is not None else stated_campaign(archives.values())
    sources = SourceCheck(folder, campaign)
    for looked in archives.values():
        if looked.attributes is not None:
            found = misplaced(looked, name)
            looked.findings.extend([found] if found is not None else sources.findings(looked))
    findings = [one for looked in archives.values() for one in looked.findings]
    status = read_status(folder / "status.csv")
    if campaign is None:
        problem = "raw files and settings were not compared"
        findings.append(Finding("campaign.toml", "not_compared", problem, unknown))
    else:
        findings += settings_findings(campaign, folder, archives, progress=progress)
        findings += missing_or_stray(campaign, archives, status)
        findings += details_findings(campaign, folder)
    findings += status_findings(archives, status)
    findings += unfinished(folder)
    progress.stage("verify tables", 0)
    n_tables, of_tables = _tables(folder, campaign, archives)
    remarks = [
        f"{one} lies on the net and was not compared (--allow-remote fetches it)"
        for one in sources.not_fetched(list(archives.values()))
    ]
    remarks += [
        f"{test} failed in its last run: {row.message}"
        for test, row in status.items()
        if row.status == "failed"
    ]
    return Verification(
        name, len(archives), sources.n_read, n_tables, (*findings, *of_tables), tuple(remarks)
    )


def _tables(
    folder: Path, campaign: Campaign | None, archives: Mapping[str, Looked]
) -> tuple[int, list[Finding]]:
    unreadable = [one.path.name for one in archives.values() if one.attributes is None]
    if unreadable:
        found = f"archives that cannot be read: {', '.join(unreadable)}"
        return 0, [Finding("tables", "not_compared", "they were not compared", found)]
    if campaign is None:
        tests = [name for name in archives if name not in OF_CAMPAIGN]
        whole = {name: archives[name].path for name in OF_CAMPAIGN if name in archives}
    else:
        tests = [name for name in tests_of(campaign) if name in archives]
        whole = products_asked(campaign, folder, has_lengths=True)
    if not (tests or whole):
        return 0, []
    return check_tables(folder, [archives[name].path for name in tests], whole)
