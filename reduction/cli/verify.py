"""Implements the command verify."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from reduction.archive.product_files import processed_folders
from reduction.batch.verification import verify_campaign
from reduction.campaign.load import find_campaign
from reduction.cli.output import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.cli.remote_paths import campaign_at
from reduction.record.errors import ArchiveError, SettingsError


def verify_products(
    processed: Path, *, campaign: Path | None, allow_remote: bool, output: CommandOutput
) -> None:
    """Verify one campaign, or all below a folder; findings give exit status 6."""
    folders = processed_folders(processed)
    if campaign is not None and folders != [processed]:
        raise SettingsError(
            "--campaign applies to the archives of one campaign",
            found=f"{processed}, which contains {', '.join(folder.name for folder in folders)}",
            needed="processed/CAMPAIGN",
        )
    answers = []
    for folder in folders:
        try:
            path = campaign or find_campaign(folder, name=folder.absolute().name)
        except SettingsError as error:  # the other folders are still checked
            output.error(f"{folder}: {error}")
            output.raise_status(error.exit_status)
            answers.append({"processed": str(folder), "is_sound": False, "problem": str(error)})
            continue
        with campaign_at(path, allow_remote=allow_remote, output=output) as loaded:
            with campaign_progress(output) as progress:
                found = verify_campaign(loaded, folder, progress=progress)
        for remark in found.remarks:
            output.say(f"  {remark}")
        for one in found.findings:
            output.error(f"{folder}/{one}")
        n_findings = len(found.findings)
        said = f"{n_findings} finding{'s' * (n_findings > 1)}" if n_findings else "all agree"
        output.say(
            f"{folder}: {found.n_archives} archives, {found.n_sources} sources, "
            f"{found.n_tables} tables: {said}"
        )
        answers.append({"processed": str(folder), "is_sound": not n_findings} | asdict(found))
        if n_findings:
            output.raise_status(ArchiveError.exit_status)
    output.answer({"campaigns": answers})
