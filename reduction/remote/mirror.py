"""Products of a campaign on the net: copied here, worked on here, and what changed put there."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from reduction.address import shown_address
from reduction.errors import ArchiveError
from reduction.remote.claim import claimed
from reduction.remote.faults import product_fault
from reduction.remote.place import base_name, below, folder_of
from reduction.remote.transfer import (
    State,
    can_be_listed,
    fetch,
    listing,
    put,
    refuse_read_only,
    remove,
)

__all__ = ["copied", "mirrored", "put_at_end"]

_BESIDE = ("status.csv", "report.json")


@contextmanager
def mirrored(address: str, folder: Path) -> Iterator[None]:
    """Work here on products that lie on the net.

    Archives, tables and status that stand there are copied here first. What changed in the
    folder is put there when the block ends, also where it ends with an error: products that were
    finished are kept. Archives go first, and ``status.csv`` last.

    Parameters
    ----------
    address : str
        Of the folder of one campaign; it need not be there yet.
    folder : pathlib.Path
        A scratch folder, which is made.

    Raises
    ------
    ArchiveError
        If a file cannot be copied, or another run has written there meanwhile.
    SettingsError
        If nothing can be written to such an address.
    """
    refuse_read_only(address)
    folder.mkdir(parents=True, exist_ok=True)
    before = _products(address)
    for name in before:
        # a listing and a look at one file may mark the same state differently
        fetch(below(address, name), folder / name, fault=product_fault)
    sums = _sums(folder)
    try:
        yield
    finally:
        now = _sums(folder)
        gone = [name for name in sums if name not in now]
        changed = [name for name in sorted(now, key=_place) if sums.get(name) != now[name]]
        if changed or gone:
            with claimed(address):
                _refuse_another_run(address, before)
                for name in changed:
                    put(folder / name, below(address, name))
                for name in gone:
                    remove(below(address, name))


@contextmanager
def put_at_end(
    address: str, folder: Path, *, beside: Callable[[str], bool] | None = None
) -> Iterator[None]:
    """Put what lies in a folder to the net when the block ends well.

    Parameters
    ----------
    address : str
        Of the folder there.
    folder : pathlib.Path
        A scratch folder.
    beside : callable, optional
        True of the name of a file that is taken away there, after all else, where it lies in a
        folder that has files here too, and is not among those.

    Raises
    ------
    ArchiveError
        If a file cannot be put there.
    SettingsError
        If nothing can be written to such an address.
    """
    refuse_read_only(address)
    yield
    names = list(_sums(folder))
    for name in names:
        put(folder / name, below(address, name))
    if beside is None:
        return
    for one in sorted({str(PurePosixPath(name).parent) for name in names}):
        own = address if one == "." else below(address, one)
        for name in listing(own):
            is_here = (folder / one / name).is_file()
            if "/" not in name and not is_here and beside(name):
                remove(below(own, name))


def copied(address: str, folder: Path, *, beside: bool = False) -> Path:
    """Copy archives from the net.

    Parameters
    ----------
    address : str
        Of one archive, or of the folder of one campaign.
    folder : pathlib.Path
        A scratch folder.
    beside : bool
        Whether the archives beside one are copied too, where its folder can be listed.

    Returns
    -------
    path : pathlib.Path
        The archive, or a folder of the same name with all archives and what is beside them.

    Raises
    ------
    ArchiveError
        If there is no archive, or it cannot be copied.
    SettingsError
        If the address is that of a folder, and such folders cannot be listed.
    """
    if not base_name(address).endswith(".nc"):
        target = folder / (base_name(address) or "campaign")
        names = [name for name in _products(address) if "/" not in name]
        if not names:
            raise ArchiveError(
                f"no archive in {shown_address(address)}",
                needed="the folder of one campaign, with <test>.nc",
                hint="Run the campaign first.",
            )
        for name in names:
            fetch(below(address, name), target / name, fault=product_fault)
        return target
    above = folder_of(address)
    path = folder / (base_name(above) or "campaign") / base_name(address)
    fetch(address, path, fault=product_fault)
    if beside and can_be_listed(address):
        for name in _products(above):
            if name.endswith(".nc") and name != path.name:
                fetch(below(above, name), path.with_name(name), fault=product_fault)
    return path


def _products(address: str) -> dict[str, State]:
    """What a run and a reader look at: archives, what is beside them, and tables."""
    return {
        name: state
        for name, state in listing(address).items()
        if _is_product(PurePosixPath(name)) and "\\" not in name
    }


def _is_product(path: PurePosixPath) -> bool:
    if path.name.startswith("."):
        return False
    folder = str(path.parent)
    return (folder == "." and (path.suffix == ".nc" or path.name in _BESIDE)) or (
        folder == "tables"
    )


def _sums(folder: Path) -> dict[str, str]:
    """Hash of each file by its name from the folder on; what begins with a dot is not finished."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.name.startswith("."):
            with path.open("rb") as file:
                found[path.relative_to(folder).as_posix()] = hashlib.file_digest(
                    file, "sha256"
                ).hexdigest()
    return found


def _place(name: str) -> tuple[bool, bool, str]:
    return name == "status.csv", not name.endswith(".nc"), name


def _refuse_another_run(address: str, before: dict[str, State]) -> None:
    now = _products(address)
    if now == before:
        return
    other = sorted(name for name in now.keys() | before.keys() if now.get(name) != before.get(name))
    raise product_fault(
        shown_address(address), "another run has written here meanwhile",
        found=", ".join(other[:5]) + (", .." if len(other) > 5 else ""),
        needed="one run at a time in a folder of products",
        hint="Nothing of this run was put there. Run again.",
    )  # fmt: skip
