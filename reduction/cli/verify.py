"""Folders of products verified one after another, and what is said of each."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path

from reduction.campaign.find import find_campaign
from reduction.campaign.plan import Campaign
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.processed import processed_folders
from reduction.cli.progress import campaign_progress
from reduction.cli.remote import campaign_at
from reduction.errors import ArchiveError, LogError, SettingsError
from reduction.verify.campaign import look_at_all, stated_campaign, verify_campaign
from reduction.verify.finding import Verification

__all__ = ["verify_products"]


def verify_products(
    processed: Path, *, campaign: Path | None, allow_remote: bool, output: CommandOutput
) -> None:
    """Verify one campaign, or all below a folder; a finding is exit status 6."""
    folders = processed_folders(processed)
    if campaign is not None and folders != [processed]:
        raise SettingsError(
            "--campaign is of one folder of products",
            found=f"{processed}, which holds {', '.join(folder.name for folder in folders)}",
            needed="processed/CAMPAIGN",
        )
    found = []
    for folder in folders:
        with ExitStack() as opened:
            with campaign_progress(output) as progress:
                archives = look_at_all(folder, progress=progress)
            name = stated_campaign(archives.values())
            loaded, unknown = _campaign_of(folder, campaign, name, allow_remote, output, opened)
            with campaign_progress(output) as progress:
                one = verify_campaign(folder, archives, loaded, unknown=unknown, progress=progress)
        _say(folder, one, output)
        found.append({"processed": str(folder), "is_sound": not one.findings} | asdict(one))
        if one.findings:
            output.raise_status(ArchiveError.exit_status)
    output.answer({"campaigns": found})


def _campaign_of(
    folder: Path,
    stated: Path | None,
    name: str,
    allow_remote: bool,
    output: CommandOutput,
    opened: ExitStack,
) -> tuple[Campaign | None, str]:
    """The campaign of a folder of products, or why it cannot be had."""
    if not name and stated is None:
        return None, "no archive here can be read, so that none says which campaign it is of"
    try:
        path = stated if stated and not name else find_campaign(folder, stated, name=name)
        at = campaign_at(str(path), allow_remote=allow_remote, output=output)
        return opened.enter_context(at), ""
    except (LogError, SettingsError) as error:
        if stated is not None:
            raise
        return None, str(error)


def _say(folder: Path, found: Verification, output: CommandOutput) -> None:
    for remark in found.remarks:
        output.say(f"  {remark}")
    for one in found.findings:
        output.error(f"{folder}/{one}")
    n_findings = len(found.findings)
    said = f"{n_findings} finding{'s' if n_findings > 1 else ''}" if n_findings else "all agree"
    output.say(
        f"{folder}: {found.n_archives} archives, {found.n_sources} sources, "
        f"{found.n_tables} tables: {said}"
    )
