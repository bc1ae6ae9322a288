"""Addresses on the net where a command takes a path: copies of this machine for the time it needs.

What a command says names the addresses, never the copies.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from signal import SIG_DFL, Signals, default_int_handler, getsignal, signal
from threading import current_thread, main_thread

from reduction.address import shown_address
from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.plan import Campaign
from reduction.campaign.staged import staged_campaign
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.remote.mirror import copied, mirrored, put_at_end
from reduction.remote.place import allowed, base_name, below
from reduction.remote.scratch import renamed, scratch_folder

__all__ = ["campaign_at", "in_order", "local_sources", "product_folders", "report_folder"]

# a machine that is shut down or a queue that ends a job; a terminal that is closed, where there are
_REQUESTS = [one for one in Signals if one.name in ("SIGTERM", "SIGHUP")]


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
    with ExitStack() as opened:
        opened.enter_context(in_order())
        with campaign_progress(output) as bar:
            campaign = opened.enter_context(
                staged_campaign(
                    address,
                    allow_remote=allow_remote,
                    progress=lambda stage, name: bar.stage(f"{stage} {name}", 0),
                )
            )
        output.names |= campaign.names
        yield campaign


@contextmanager
def in_order() -> Iterator[None]:
    """Take a request to end as an interruption: lock, workers and copies are put away first.

    One that the caller ignores, as ``nohup`` does, stays ignored.
    """
    before = {}
    if current_thread() is main_thread():
        asked = [number for number in _REQUESTS if getsignal(number) == SIG_DFL]
        before = {number: signal(number, default_int_handler) for number in asked}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal(number, handler)


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
    is_remote = allowed(processed, allow_remote, what="--processed")
    with (
        report_folder(reports, allow_remote=allow_remote, output=output) as pages,
        renamed(output.names),
        ExitStack() as opened,  # closed first: a page follows the products that it shows
    ):
        folder = Path(processed)
        if is_remote:
            folder = opened.enter_context(scratch_folder())
            output.names[str(folder)] = shown_address(processed).rstrip("/")
            opened.enter_context(mirrored(below(processed, campaign.id), folder / campaign.id))
        yield replace(campaign, names=campaign.names | output.names), folder, pages


@contextmanager
def report_folder(reports: str, *, allow_remote: bool, output: CommandOutput) -> Iterator[Path]:
    """Give a folder of this machine to write pages into; on the net they appear at the end.

    Parameters
    ----------
    reports : str
        Path or address of the folder in which campaigns have theirs.
    allow_remote : bool
        Whether it may be an address.
    output : CommandOutput
        Learns what the copy is called.

    Yields
    ------
    folder : pathlib.Path
        Where to write.

    Raises
    ------
    SettingsError
        If it is an address and addresses are not allowed, or nothing can be written there.
    ArchiveError
        If a page cannot be put there.
    """
    if not allowed(reports, allow_remote, what="--reports"):
        yield Path(reports)
        return
    # what draws is not needed to read
    from reduction.report.page import is_page_beside

    with scratch_folder() as folder, renamed(output.names):
        output.names[str(folder)] = shown_address(reports).rstrip("/")
        with put_at_end(reports, folder, beside=is_page_beside):
            yield folder


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
        opened.enter_context(in_order())
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
