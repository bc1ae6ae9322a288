"""Copies of whole files between the net and this machine, each checked by its size.

How often a store is asked again after a fault is left to the package that speaks to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

from reduction.address import shown_address
from reduction.errors import LogError, SettingsError
from reduction.remote.faults import Fault, attempt, product_fault, said_of
from reduction.remote.place import Place, connect

__all__ = [
    "State",
    "can_be_listed",
    "fetch",
    "listing",
    "put",
    "refuse_read_only",
    "remove",
    "state_of",
]

_READ_ONLY = {"http", "https"}
# what tells two states of a file apart, as far as a file system says it; the surest first
_MARKS = (
    "ETag", "etag", "generation", "md5Hash", "content_md5", "LastModified", "last_modified",
    "Last-Modified", "mtime", "modified", "updated", "created",
)  # fmt: skip


@dataclass(frozen=True)
class State:
    """Size of a file [bytes], None where it is not said, and a mark that changes with it."""

    size: int | None
    mark: str


def state_of(address: str, *, fault: Fault = LogError) -> State:
    """What a file on the net is now.

    Parameters
    ----------
    address : str
        Of the file.
    fault : callable
        Makes the error.

    Returns
    -------
    state : State
        Not from a cache.

    Raises
    ------
    ReductionError
        From ``fault``, if it is not there or may not be looked at.
    SettingsError
        If no package speaks to such an address.
    """
    place = connect(address)
    return attempt(lambda: _state(place), address, fault, doing="read")


def fetch(
    address: str, target: Path, *, before: State | None = None, fault: Fault = LogError
) -> State:
    """Copy a file from the net, in blocks.

    Parameters
    ----------
    address : str
        Of the file.
    target : pathlib.Path
        The copy; its folder is made. Nothing stands there where the copy is not whole.
    before : State, optional
        As the file was when it was chosen; looked at now where left out.
    fault : callable
        Makes the error.

    Returns
    -------
    state : State
        Of what was copied.

    Raises
    ------
    ReductionError
        From ``fault``, if the file is not there, may not be read, breaks off or changes meanwhile.
    SettingsError
        If no package speaks to such an address.
    """
    before = before or state_of(address, fault=fault)
    place = connect(address)
    _make_room(target, address, fault)
    try:
        attempt(
            lambda: place.system.get_file(place.path, str(target)), address, fault, doing="read",
            begun=lambda: _arrived(target, before),
        )  # fmt: skip
        after = state_of(address, fault=fault)
        size = target.stat().st_size
        if after != before:
            raise fault(
                shown_address(address), "the file changed while it was read",
                found=f"{_in_words(before)}, then {_in_words(after)}",
                needed="a file that nothing writes to",
                hint="Wait until the logger or the copy has ended.",
            )  # fmt: skip
        if before.size not in (None, size):
            raise fault(
                shown_address(address), "the transfer broke off",
                found=f"{size} bytes", needed=f"{before.size} bytes",
            )  # fmt: skip
    except BaseException:
        target.unlink(missing_ok=True)
        raise
    return after


def put(source: Path, address: str) -> None:
    """Write a file to the net: it appears there whole or not at all.

    Parameters
    ----------
    source : pathlib.Path
        A file of this machine.
    address : str
        What it is to be; a file that is there is replaced at the very end, or kept.

    Raises
    ------
    ArchiveError
        If it may not be written, or does not arrive.
    SettingsError
        If nothing can be written to such an address.
    """
    refuse_read_only(address)
    place = connect(address)
    size = attempt(lambda: _put(source, place), address, product_fault, doing="written")
    expected = source.stat().st_size
    if size not in (None, expected):
        raise product_fault(
            shown_address(address), "the file did not arrive whole",
            found=f"{size} bytes", needed=f"{expected} bytes",
        )  # fmt: skip


def remove(address: str) -> None:
    """Take a file on the net away.

    Parameters
    ----------
    address : str
        Of the file.

    Raises
    ------
    ArchiveError
        If that is not allowed.
    """
    place = connect(address)
    attempt(lambda: place.system.rm_file(place.path), address, product_fault, doing="removed")


def listing(address: str) -> dict[str, State]:
    """Files below a folder on the net.

    Parameters
    ----------
    address : str
        Of the folder.

    Returns
    -------
    files : dict of str to State
        By their names from the folder on; none where there is no such folder.

    Raises
    ------
    ArchiveError
        If it may not be looked at.
    SettingsError
        If no package speaks to such an address, or it has no folders.
    """
    place = connect(address)
    if not can_be_listed(address):
        raise SettingsError(
            f"a folder behind {place.protocol}:// cannot be listed", found=shown_address(address),
            needed="the address of one file, or a store such as s3:// or gs://",
        )  # fmt: skip
    root = place.path.rstrip("/") + "/"
    found = attempt(lambda: _found(place), address, product_fault, doing="read")
    return {
        name.removeprefix(root): _state_from(about)
        for name, about in sorted(found.items())
        if name.startswith(root)
    }


def can_be_listed(address: str) -> bool:
    """Whether such an address has folders, whose files a store can name."""
    return connect(address).protocol not in _READ_ONLY


def refuse_read_only(address: str) -> None:
    """Raise `SettingsError` where nothing can be written to such an address."""
    protocol = connect(address).protocol
    if protocol in _READ_ONLY:
        raise SettingsError(
            f"nothing can be written to {protocol}://", found=shown_address(address),
            needed="a folder on this machine, or a store such as s3:// or gs://",
        )  # fmt: skip


def _make_room(target: Path, address: str, fault: Fault) -> None:
    """Begin the copy: a name that this machine refuses is no transfer that broke off."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.open("wb").close()
        return
    except (FileExistsError, NotADirectoryError, IsADirectoryError) as error:
        told = fault(
            shown_address(address), "its copy would lie where another file is",
            found=error.strerror, needed="files of which none is the folder of another",
        )  # fmt: skip
    except OSError as error:
        told = said_of(error, address, fault, doing="copied")
    raise told  # out here it has no cause and no context


def _found(place: Place) -> dict[str, dict[str, Any]]:
    place.system.invalidate_cache()
    try:
        return dict(place.system.find(place.path, detail=True))
    except FileNotFoundError:
        return {}


def _put(source: Path, place: Place) -> int | None:
    """Write a file, and give the size that it has there."""
    if place.is_whole:
        place.system.put_file(str(source), place.path)
    else:
        _put_and_name(source, place)
    return _state(place).size


def _put_and_name(source: Path, place: Place) -> None:
    """Write beside, under a name that begins with a dot, and rename at the end."""
    folder, _, name = place.path.rpartition("/")
    part = f"{folder}/.{name}.{uuid4().hex}.part"
    if folder:
        place.system.makedirs(folder, exist_ok=True)
    try:
        place.system.put_file(str(source), part)
        place.system.mv(part, place.path)
    except BaseException:
        if place.system.exists(part):
            place.system.rm_file(part)
        raise


def _state(place: Place) -> State:
    place.system.invalidate_cache()
    about = place.system.info(place.path)
    if about.get("type") == "directory":
        raise IsADirectoryError
    return _state_from(about)


def _state_from(about: dict[str, Any]) -> State:
    mark = next((about[name] for name in _MARKS if about.get(name) is not None), "")
    size = about.get("size")
    return State(None if size is None else int(size), str(mark))


def _arrived(target: Path, before: State) -> str:
    """How much of a file is here, for a message."""
    size = target.stat().st_size if target.exists() else 0
    return f"{size} bytes" if before.size is None else f"{size} of {before.size} bytes"


def _in_words(state: State) -> str:
    size = "an unknown size" if state.size is None else f"{state.size} bytes"
    return f"{size} ({state.mark})" if state.mark else size
