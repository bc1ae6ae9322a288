"""Bringing the index up to date: what is not as it was is read again, what is gone is taken out."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from reduction.catalogue.changes import Changes
from reduction.catalogue.entry import ArchiveEntry
from reduction.catalogue.files import shown_path
from reduction.catalogue.index import Index, index_of, joined, save_index
from reduction.catalogue.read import identity_of, read_entry
from reduction.errors import ArchiveError

__all__ = ["Refreshed", "refresh"]


@dataclass(frozen=True)
class Refreshed:
    """The index as it is now.

    Parameters
    ----------
    index : Index
        All of it.
    n_read : int
        Archives that were read.
    not_kept : str
        Why the file could not be written; empty where it was.
    """

    index: Index
    n_read: int
    not_kept: str = ""


def refresh(old: Index | None, changes: Changes, path: Path, *, jobs: int = 1) -> Refreshed:
    """Read what changed, and write the index.

    Parameters
    ----------
    old : Index, optional
        With all its numbers; None: every archive is read.
    changes : Changes
        Of the folder against ``old``.
    path : pathlib.Path
        The index; it appears whole or not at all.
    jobs : int
        Processes that read archives.

    Returns
    -------
    refreshed : Refreshed
        A folder that takes no file gives an index all the same, and the reason.
    """
    states = changes.states
    copied = {
        name
        for name, identity in changes.copied.items()
        if old is not None and _identity(changes.paths[name]) == identity
    }
    stays = copied if old is None else copied | changes.same
    to_read = [name for name in states if name not in stays]
    entries = _read([(changes.paths[name], name) for name in to_read], jobs)
    added = index_of([(entry, states[name]) for entry, name in zip(entries, to_read, strict=True)])
    kept = Index.empty() if old is None else old
    index = joined(kept.with_states({name: states[name] for name in copied}), stays, added)
    try:
        save_index(index, path)
    except OSError as error:
        return Refreshed(index, len(to_read), shown_path(f"{path}: {error.strerror or error}"))
    return Refreshed(index, len(to_read))


def _identity(path: Path) -> str:
    try:
        return identity_of(path)
    except ArchiveError:
        return ""


def _read(archives: Sequence[tuple[Path, str]], jobs: int) -> list[ArchiveEntry]:
    if jobs == 1 or len(archives) < 2 * jobs:
        return [read_entry(path, name) for path, name in archives]
    at_once = max(1, min(32, len(archives) // (4 * jobs)))
    paths, names = zip(*archives, strict=True)
    # a fresh interpreter: libraries of this one may hold threads
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        return list(pool.map(read_entry, paths, names, chunksize=at_once))
