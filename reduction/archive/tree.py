"""A processed campaign as one tree of datasets, read from the disk as far as it is looked at."""

from __future__ import annotations

import atexit
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr

from reduction.address import shown_address
from reduction.archive.open import Chunks, open_archive
from reduction.archive.products import OF_CAMPAIGN, archives_of_tests
from reduction.errors import ArchiveError, SettingsError
from reduction.remote.mirror import copied
from reduction.remote.place import allowed
from reduction.remote.scratch import renamed, scratch_folder

__all__ = ["open_campaign"]

# what an archive says of itself: of a campaign with one archive it is not said either
_OF_ONE_ARCHIVE = frozenset(
    {
        "id", "test", "test_kind", "test_order", "raw_file", "raw_file_sha256", "raw_file_bytes",
        "raw_metadata", "stored_samples", "settings", "history",
    }
)  # fmt: skip


def open_campaign(
    path: str | Path, *, chunks: Chunks | None = None, allow_remote: bool = False
) -> xr.DataTree | xr.Dataset:
    """Open a processed campaign, or one of its archives; nothing but labels is read.

    Parameters
    ----------
    path : str or pathlib.Path
        ``processed/<campaign>``, or one archive in it; an address on the net as text.
    chunks : int or mapping of str to int or "auto", optional
        Passed on to Dask, if it is installed: values of a chunk by dimension, such as
        ``{"sample": 655360}`` or ``{"sample": "auto"}``; ``{}`` for chunks as they are stored.
        Without it variables are no Dask arrays, and are read when they are asked for all the same.
    allow_remote : bool
        Whether archives are copied from an address on the net. The copies are gone when what
        was opened is closed, or Python ends.

    Returns
    -------
    campaign : xarray.DataTree or xarray.Dataset
        Of a folder a tree: one node a test (a step is ``<test>.<step>``), and nodes ``surfaces``,
        ``outcomes``, ``predictions``, ``comparisons`` and ``change_in_length`` where there are
        such archives; the attributes in which all of them agree stand on the root. Of a file
        its dataset. To be closed, or used with ``with``.

    Raises
    ------
    ArchiveError
        If there is nothing of that name, no archive in the folder, a file that is no archive of
        this version, the archives are of more than one campaign, or cannot be copied.
    SettingsError
        If Dask is wanted and not installed, refuses the chunks, or no archive has a dimension
        of the name; if it is an address and addresses are not allowed.

    Examples
    --------
    >>> import reduction
    >>> reduction.open_campaign("processed/none")
    Traceback (most recent call last):
    reduction.errors.ArchiveError: there is no processed campaign processed/none; needed
    the folder of a campaign in processed/, or an archive. Run the campaign first.
    """
    if not allowed(str(path), allow_remote, what="the campaign"):
        return _opened(Path(path), chunks)
    names: dict[str, str] = {}
    with ExitStack() as scratch, renamed(names):
        copy = copied(str(path), scratch.enter_context(scratch_folder()))
        names[str(copy)] = shown_address(str(path))
        kept = ExitStack()
        campaign = _opened(copy, chunks, at_end=kept.close)
        kept.push(scratch.pop_all())
    atexit.register(kept.close)  # of one that is never closed
    return campaign


def _opened(
    path: Path, chunks: Chunks | None, at_end: Callable[[], None] | None = None
) -> xr.DataTree | xr.Dataset:
    """Open what lies on this machine; ``at_end`` is called when all of it is closed."""
    if path.is_file():
        with ExitStack() as opened:
            archive = opened.enter_context(open_archive(path, chunks=chunks))
            _refuse_unknown(chunks, [archive])
            opened.pop_all()
        if at_end is None:
            return archive
        # its own way to close it stays with the archive
        again = archive.copy()
        again.set_close(partial(_in_turn, archive.close, at_end))
        return again
    if not path.is_dir():
        raise ArchiveError(
            f"there is no processed campaign {path.as_posix()}",
            needed="the folder of a campaign in processed/, or an archive",
            hint="Run the campaign first.",
        )
    whole = (path / f"{name}.nc" for name in OF_CAMPAIGN)
    archives = [*archives_of_tests(path), *(one for one in whole if one.is_file())]
    if not archives:
        raise _without_archives(path)
    with ExitStack() as opened:
        nodes = {
            one.stem: opened.enter_context(open_archive(one, chunks=chunks)) for one in archives
        }
        _refuse_unknown(chunks, nodes.values())
        _refuse_several({name: one.attrs.get("campaign", "") for name, one in nodes.items()})
        root = xr.Dataset(attrs=_in_common(one.attrs for one in nodes.values()))
        tree = xr.DataTree.from_dict({"/": root} | nodes, name=root.attrs.get("campaign"))
        # each file is now closed by its node
        for name, one in nodes.items():
            tree[name].set_close(one.close)
        if at_end is not None:
            tree[name].set_close(partial(_in_turn, one.close, at_end))
        opened.pop_all()
    return tree


def _in_turn(*calls: Callable[[], None]) -> None:
    for call in calls:
        call()


def _without_archives(folder: Path) -> ArchiveError:
    """Say what to open instead where the folder is the one above."""
    campaigns = sorted({one.parent.name for one in folder.glob("*/*.nc")})
    return ArchiveError(
        f"no archive in {folder.as_posix()}",
        found=f"folders of campaigns: {', '.join(campaigns)}" if campaigns else "no .nc file",
        needed="the folder of one campaign, with <test>.nc",
        hint="Open one of them." if campaigns else "Run the campaign first.",
    )


def _refuse_unknown(chunks: Chunks | None, archives: Collection[xr.Dataset]) -> None:
    """One that only some archives have is right; one that none has is misspelt."""
    dimensions = {str(name) for one in archives for name in one.dims}
    named = chunks if isinstance(chunks, Mapping) else ()
    unknown = sorted(set(named) - dimensions)
    if unknown:
        raise SettingsError(
            "chunks name a dimension that no archive has",
            found=", ".join(unknown),
            needed=", ".join(sorted(dimensions)),
        )


def _refuse_several(campaigns: Mapping[str, str]) -> None:
    if len(set(campaigns.values())) > 1:
        raise ArchiveError(
            "the archives in this folder are of more than one campaign",
            found=", ".join(f"{name} of {campaign}" for name, campaign in campaigns.items()),
            needed="one campaign a folder",
            hint="Open each archive by its own path.",
        )


def _in_common(attributes: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Attributes that every archive has with the same text, in the order of the first."""
    first, *others = attributes
    return {
        name: text
        for name, text in first.items()
        if name not in _OF_ONE_ARCHIVE and all(one.get(name) == text for one in others)
    }
