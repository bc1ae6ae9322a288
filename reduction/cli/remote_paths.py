"""Remote addresses in place of paths: fetched to a local copy.

Messages name the addresses, never the copies.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from signal import SIG_DFL, Signals, default_int_handler, getsignal, signal
from threading import current_thread, main_thread
from typing import TYPE_CHECKING

from reduction.cli.output import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.readers.remote_files import (
    allowed,
    base_name,
    fetch,
    product_fault,
    renamed,
    scratch_folder,
)
from reduction.record.errors import SettingsError
from reduction.record.plain_text import shown_address

if TYPE_CHECKING:
    from reduction.campaign.plan import Campaign

# from a machine shutting down or a queue ending a job; from a closed terminal, if supported
_REQUESTS = [one for one in Signals if one.name in ("SIGTERM", "SIGHUP")]


@contextmanager
def campaign_at(path: Path, *, allow_remote: bool, output: CommandOutput) -> Iterator[Campaign]:
    """Load a campaign and fetch its logs."""
    from reduction.campaign.load import staged_campaign  # a look-up needs no campaign

    with ExitStack() as opened:
        opened.enter_context(in_order())
        with campaign_progress(output) as bar:
            campaign = opened.enter_context(
                staged_campaign(
                    path,
                    allow_remote=allow_remote,
                    progress=lambda stage, name: bar.stage(f"{stage} {name}", 0),
                )
            )
        output.names |= campaign.names
        yield campaign


@contextmanager
def in_order() -> Iterator[None]:
    """Treat a request to end like an interruption: lock, workers and copies are cleaned up."""
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
def local_sources(
    sources: Sequence[str], *, allow_remote: bool, output: CommandOutput
) -> Iterator[list[str]]:
    """Copy each source that is the address of an archive."""
    with ExitStack() as opened:
        opened.enter_context(in_order())
        opened.enter_context(renamed(output.names))
        found = []
        for source in sources:
            if not allowed(source, allow_remote, what="the source"):
                found.append(source)
                continue
            name = base_name(source)
            if not name.endswith(".nc"):
                raise SettingsError(
                    "the source is a URL, but not of an archive", found=shown_address(source),
                    needed="the URL of one archive, such as s3://bucket/processed/tmt/T-1.nc, or a "
                    "local folder",
                    hint="Copy the folder here first, e.g. with aws s3 sync or rclone.",
                )  # fmt: skip
            above = base_name(shown_address(source).rpartition("/")[0]) or "campaign"
            copy = opened.enter_context(scratch_folder()) / above / name
            fetch(source, copy, fault=product_fault)
            output.names[str(copy)] = shown_address(source)
            found.append(str(copy))
        yield found
