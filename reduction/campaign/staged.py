"""A campaign whose files lie on the net, wholly or in part: copied to a scratch folder, then read.

Each file is copied once, before anything is reduced, so that every stage works on files of
this machine and the hash of a product is the hash of what was read.
"""

from __future__ import annotations

import re
import shutil
import tomllib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path, PurePosixPath

from reduction.address import is_address, shown_address
from reduction.campaign.faults import named_tables
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign
from reduction.campaign.textfiles import read_small_text
from reduction.errors import LogError
from reduction.remote.place import allowed, base_name, below, folder_of
from reduction.remote.scratch import renamed, scratch_folder
from reduction.remote.transfer import State, fetch, state_of

__all__ = ["staged_campaign"]

_UNUSUAL = re.compile(r"[^\w.\-]")
Progress = Callable[[str, str], None]


@contextmanager
def staged_campaign(
    address: str | Path, *, allow_remote: bool = False, progress: Progress | None = None
) -> Iterator[Campaign]:
    """Load a campaign from this machine or from the net, with its logs at hand.

    Parameters
    ----------
    address : str or pathlib.Path
        The campaign.toml: a path, or an address on the net, beside which its files lie.
    allow_remote : bool
        Whether anything is fetched from the net.
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
        If something is an address and addresses are not allowed; else as `load_campaign`.
    LogError
        If campaign.toml, or a table that it names, cannot be fetched or read, or there is no
        room for copies.
    """
    is_remote = allowed(str(address), allow_remote, what="the campaign")
    if not allow_remote:
        yield load_campaign(Path(address))
        return
    said = progress or (lambda stage, name: None)
    names: dict[str, str] = {}
    with scratch_folder() as scratch, renamed(names):
        base, path = "", Path(address)
        if is_remote:
            base = folder_of(str(address))
            path = scratch / "campaign" / (base_name(str(address)) or "campaign.toml")
            names |= {str(path): shown_address(str(address)), str(path.parent): shown_address(base)}
            said("fetch", path.name)
            fetch(str(address), path)
            _fetch_tables(base, path, said)
        campaign = load_campaign(path, allow_remote=True)
        yield _with_logs(campaign, base, scratch / "logs", names, said)


def _fetch_tables(base: str, path: Path, progress: Progress) -> None:
    """Copy the tables and marks that a campaign names beside it; one that is not there is not."""
    try:
        table = tomllib.loads(read_small_text(path))
    except (ValueError, RecursionError):
        return  # it is refused when it is loaded
    for name in named_tables(path.parent, table):
        if _is_below(name):
            progress("fetch", name)
            try:
                fetch(below(base, name), path.parent / name)
            except LogError as error:
                if error.problem != "there is no such file":
                    raise


def _is_below(name: str) -> bool:
    """Whether a name stays in the folder of the campaign; one that does not is refused later."""
    parts = PurePosixPath(name).parts
    return bool(parts) and not is_address(name) and parts[0] != "/" and ".." not in parts


def _with_logs(
    campaign: Campaign, base: str, folder: Path, names: dict[str, str], progress: Progress
) -> Campaign:
    """Copy each log that lies on the net; ``names`` learns what the copies are called."""
    wanted: dict[str, tuple[str, Path]] = {}
    for place, name in enumerate(
        dict.fromkeys(name for plan in campaign.tests.values() for name, _ in plan.files)
    ):
        if name in campaign.addresses:
            copy = folder / str(place) / (_UNUSUAL.sub("_", base_name(name))[-100:] or "log")
            wanted[name] = (campaign.addresses[name], copy)
            names[str(copy)] = name
        elif base:
            wanted[name] = (below(base, name), campaign.folder / name)
    unread: dict[str, LogError] = {}
    states: dict[str, State] = {}
    for name, (address, _) in wanted.items():
        try:
            states[name] = state_of(address)
        except LogError as error:
            unread[name] = error
    _refuse_too_much(campaign, folder.parent, list(states.values()))
    # one after another: not every package bears threads, and an interruption ends at once
    for name, before in states.items():
        progress("fetch", name)
        try:
            fetch(*wanted[name], before=before)
        except LogError as error:
            unread[name] = error
    return replace(
        campaign,
        addresses={},
        copies={name: copy for name, (_, copy) in wanted.items()},
        unread=unread,
        names=dict(names),
    )


def _refuse_too_much(campaign: Campaign, scratch: Path, states: Sequence[State]) -> None:
    size = sum(one.size or 0 for one in states)
    room = shutil.disk_usage(scratch).free
    if size > room:
        raise LogError(
            campaign.path, "there is no room on this machine for copies of the logs",
            found=f"{room} bytes free in {scratch.parent}", needed=f"{size} bytes",
            hint="Free some space, or name another folder in the variable TMPDIR.",
        )  # fmt: skip
