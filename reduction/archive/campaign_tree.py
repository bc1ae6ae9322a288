"""A processed campaign as a tree of datasets, loaded on demand."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import xarray as xr

from reduction.archive.open import Chunks, open_archive
from reduction.archive.product_files import OF_CAMPAIGN, archives_of_tests, earlier_run_words
from reduction.record.errors import ArchiveError, SettingsError

# attributes of a single archive: excluded even for a campaign with one archive
_OF_ONE_ARCHIVE = frozenset(
    {
        "id", "test", "test_kind", "test_order", "test_status", "raw_file", "raw_file_sha256",
        "raw_file_bytes", "raw_metadata", "stored_samples", "settings", "key", "history",
    }
)  # fmt: skip


def open_campaign(path: str | Path, *, chunks: Chunks | None = None) -> xr.DataTree | xr.Dataset:
    """Open a processed campaign, or one of its archives; only labels are read.

    Parameters
    ----------
    path : str or pathlib.Path
        ``processed/<campaign>``, or one archive in it.
    chunks : int or mapping of str to int or "auto", optional
        Passed to Dask, if installed: chunk size in values by dimension, such as ``{"sample":
        655360}`` or ``{"sample": "auto"}``; ``{}`` for stored chunks. Without it variables are not
        Dask arrays, but are still read on demand.

    Returns
    -------
    campaign : xarray.DataTree or xarray.Dataset
        For a folder, a tree: one node per test (a step is ``<test>.<step>``), and nodes
        ``surfaces``, ``outcomes``, ``predictions``, ``comparisons`` and ``change_in_length`` for
        existing archives; attributes common to all of them are on the root. For a file, its
        dataset. Close it, or use it with ``with``.

    Raises
    ------
    ArchiveError
        If there is nothing with that name, no archive in the folder, a file that is not an archive
        of this version, or archives from more than one campaign.
    SettingsError
        If Dask is requested and not installed, refuses the chunks, or no archive has a dimension
        with that name.

    Examples
    --------
    >>> import reduction
    >>> reduction.open_campaign("processed/none")
    Traceback (most recent call last):
    reduction.record.errors.ArchiveError: there is no processed campaign processed/none; needed
    the folder of a campaign in processed/, or an archive. Run the campaign first.
    """
    path = Path(path)
    if path.is_file():
        with ExitStack() as opened:
            archive = opened.enter_context(open_archive(path, chunks=chunks))
            _refuse_unknown(chunks, [archive])
            _warn_of_earlier_runs([path])
            opened.pop_all()
        return archive
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
        _warn_of_earlier_runs(archives)
        root = xr.Dataset(attrs=_in_common(one.attrs for one in nodes.values()))
        tree = xr.DataTree.from_dict({"/": root} | nodes, name=root.attrs.get("campaign"))
        # from here on each node closes its own file
        for name, one in nodes.items():
            tree[name].set_close(one.close)
        opened.pop_all()
    return tree


def _warn_of_earlier_runs(archives: Iterable[Path]) -> None:
    for path in archives:
        for text in earlier_run_words(path):
            warnings.warn(text, stacklevel=3)


def _without_archives(folder: Path) -> ArchiveError:
    """Error that suggests a folder to open if this one is above it."""
    campaigns = sorted({one.parent.name for one in folder.glob("*/*.nc")})
    return ArchiveError(
        f"no archive in {folder.as_posix()}",
        found=f"folders of campaigns: {', '.join(campaigns)}" if campaigns else "no .nc file",
        needed="the folder of one campaign, with <test>.nc",
        hint="Open one of them." if campaigns else "Run the campaign first.",
    )


def _refuse_unknown(chunks: Chunks | None, archives: Collection[xr.Dataset]) -> None:
    """Refuse a dimension found in no archive, as a misspelling; one found in some is valid."""
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
    """Attributes with the same text in all archives, in the order of the first."""
    first, *others = attributes
    return {
        name: text
        for name, text in first.items()
        if name not in _OF_ONE_ARCHIVE and all(one.get(name) == text for one in others)
    }
