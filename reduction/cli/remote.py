"""Addresses on the net where a command takes a path: copies of this machine for the time it needs.

What a command says names the addresses, never the copies.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

from reduction.address import shown_address
from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.plan import Campaign
from reduction.campaign.staged import staged_campaign
from reduction.cli.commandoutput import CommandOutput
from reduction.remote.mirror import copied, mirrored
from reduction.remote.place import allowed, base_name, below
from reduction.remote.scratch import renamed, scratch_folder

__all__ = ["campaign_at", "local_sources", "product_folders"]


@contextmanager
def campaign_at(address: str, *, allow_remote: bool, output: CommandOutput) -> Iterator[Campaign]:
    """Load a campaign from a path or an address, with its logs at hand.

    Parameters
    ----------
    address : str
        The campaign.toml.
    allow_remote : bool
        Whether anything is fetched from the net.
    output : CommandOutput
        Learns what copies are called.

    Yields
    ------
    campaign : Campaign
        Copies of its files are gone when the block ends.
    """
    with staged_campaign(address, allow_remote=allow_remote) as campaign:
        output.names |= campaign.names
        yield campaign


@contextmanager
def product_folders(
    campaign: Campaign, processed: str, reports: str, *, allow_remote: bool, output: CommandOutput
) -> Iterator[tuple[Campaign, Path, Path]]:
    """Give folders of this machine to write products into; on the net they appear at the end.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    processed, reports : str
        Paths or addresses of the folders in which campaigns have theirs.
    allow_remote : bool
        Whether they may be addresses.
    output : CommandOutput
        Learns what copies are called.

    Yields
    ------
    campaign : Campaign
        Whose messages name the addresses.
    processed, reports : pathlib.Path
        Where to write.

    Raises
    ------
    SettingsError
        If one is an address and addresses are not allowed, or nothing can be written there.
    ArchiveError
        If products cannot be copied from there, or put there.
    """
    with ExitStack() as opened:
        folders = []
        opened.enter_context(renamed(output.names))
        for what, address, fetched in (
            ("--processed", processed, True), ("--reports", reports, False),
        ):  # fmt: skip
            if not allowed(address, allow_remote, what=what):
                folders.append(Path(address))
                continue
            folder = opened.enter_context(scratch_folder())
            output.names[str(folder)] = shown_address(address).rstrip("/")
            opened.enter_context(
                mirrored(below(address, campaign.id), folder / campaign.id, fetched=fetched)
            )
            folders.append(folder)
        first, second = folders
        yield replace(campaign, names=campaign.names | output.names), first, second


@contextmanager
def local_sources(
    sources: Sequence[str], *, allow_remote: bool, output: CommandOutput
) -> Iterator[list[str]]:
    """Copy each source that is an address: an archive, or the folder of a processed campaign.

    Parameters
    ----------
    sources : sequence of str
        Names, paths or addresses.
    allow_remote : bool
        Whether they may be addresses.
    output : CommandOutput
        Learns what copies are called.

    Yields
    ------
    sources : list of str
        The path of the copy in place of an address; the others as they were given.

    Raises
    ------
    SettingsError
        If one is an address and addresses are not allowed.
    ArchiveError
        If there is no archive, or it cannot be copied.
    """
    with ExitStack() as opened:
        opened.enter_context(renamed(output.names))
        found = []
        for source in sources:
            if not allowed(source, allow_remote, what="the source"):
                found.append(source)
                continue
            folder = opened.enter_context(scratch_folder())
            is_whole = base_name(source).removesuffix(".nc") in OF_CAMPAIGN
            copy = copied(source, folder, beside=is_whole)
            output.names[str(copy)] = shown_address(source)
            found.append(str(copy))
        yield found
