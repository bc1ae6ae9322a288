"""A campaign of which logs lie on the net: copied to a scratch folder before anything is reduced.

Every stage works on files of this machine, and the hash of a product is the hash of what was read.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign
from reduction.errors import LogError
from reduction.remote import base_name, fetch, renamed, scratch_folder

_UNUSUAL = re.compile(r"[^\w.\-]")


@contextmanager
def staged_campaign(
    path: Path, *, allow_remote: bool = False, progress: Callable[[str, str], None] | None = None
) -> Iterator[Campaign]:
    """Load a campaign with its logs at hand.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    allow_remote : bool
        Whether logs are fetched from the net.
    progress : callable, optional
        Called with ("fetch", name) before each file.

    Yields
    ------
    campaign : Campaign
        As `load_campaign` gives it. A log that cannot be fetched is its test's error. Copies
        are gone when the block ends.

    Raises
    ------
    SettingsError
        If a log is an address and addresses are not allowed; else as `load_campaign`.
    """
    campaign = load_campaign(path, allow_remote=allow_remote)
    if not campaign.addresses:
        yield campaign
        return
    names: dict[str, str] = {}
    copies: dict[str, Path] = {}
    unread: dict[str, LogError] = {}
    with scratch_folder() as scratch, renamed(names):
        # one after another: not every package bears threads, and an interruption ends at once
        for place, (name, address) in enumerate(campaign.addresses.items()):
            copy = scratch / str(place) / (_UNUSUAL.sub("_", base_name(name))[-100:] or "log")
            copies[name], names[str(copy)] = copy, name
            if progress is not None:
                progress("fetch", name)
            try:
                fetch(address, copy)
            except LogError as error:
                unread[name] = error
        yield replace(campaign, addresses={}, copies=copies, unread=unread, names=dict(names))
