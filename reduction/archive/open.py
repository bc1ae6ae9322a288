"""Opening an archive: only a file that this version understands."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

import netCDF4
import xarray as xr

from reduction.archive.seal import check_seal
from reduction.archive.sound import check_form, check_stored
from reduction.archive.version import SCHEMA_VERSION
from reduction.errors import ArchiveError, SettingsError

__all__ = ["Chunks", "Opener", "failing_reads", "open_archive", "reading"]

Chunks = int | Mapping[str, int | Literal["auto"] | tuple[int, ...]]
"""Values of a chunk, or by dimension, as `xarray.open_dataset` takes them."""

Opener = Callable[[Path], AbstractContextManager[xr.Dataset]]
"""How a step opens an archive for a block: as `reading` does."""

_CACHE = 1 << 20
"""Bytes of each variable that the library keeps as they are read: two chunks of an archive. Its own
64 MB hold all that was ever read of a test, beside what is made of it."""


_OF_LIBRARY = re.compile(r"(\[Errno -\d+\] )?NetCDF: ")
_OF_DISK = re.compile(r"HDF error|HDF5 attribute")
_AGAIN = "Check the disk; take a copy that is whole, or reduce the campaign again."


@contextmanager
def reading(path: Path) -> Iterator[xr.Dataset]:
    """Open an archive for a block in which its values are read, and close it.

    Parameters
    ----------
    path : pathlib.Path
        A file that `write_archive` wrote.

    Yields
    ------
    dataset : xarray.Dataset
        As `open_archive` gives it.

    Raises
    ------
    ArchiveError
        As `open_archive`, and if the library fails while something is read in the block.
    """
    with failing_reads(str(path)), open_archive(path) as dataset:
        yield dataset


@contextmanager
def failing_reads(what: str) -> Iterator[None]:
    """Turn errors of the netCDF library in a block into those of an archive.

    Parameters
    ----------
    what : str
        The file, or files, that are read in the block, for the message.

    Raises
    ------
    ArchiveError
        If the library fails; other errors are passed on as they are.

    Notes
    -----
    Values are read when they are asked for, so that a disk may fail long after a file was opened.
    The library raises `RuntimeError`, `AttributeError` or `OSError` then, and names no file.

    Examples
    --------
    >>> with failing_reads("processed/nylon/T-1.nc"):
    ...     raise RuntimeError("NetCDF: HDF error")
    Traceback (most recent call last):
    reduction.errors.ArchiveError: processed/nylon/T-1.nc cannot be read; found NetCDF: HDF
    error. Check the disk; take a copy that is whole, or reduce the campaign again.
    """
    try:
        yield
    except (AttributeError, OSError, RuntimeError) as error:
        if not _OF_LIBRARY.match(str(error)):
            raise
        raise _unreadable(what, error) from error


def _unreadable(what: str, error: Exception) -> ArchiveError:
    return ArchiveError(
        f"{what} cannot be read", found=_OF_LIBRARY.sub("NetCDF: ", _words(error)), hint=_AGAIN
    )


def _words(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]


def open_archive(path: Path, *, chunks: Chunks | None = None) -> xr.Dataset:
    """Open an archive; values are read from the disk when they are asked for.

    Parameters
    ----------
    path : pathlib.Path
        A file that `write_archive` wrote.
    chunks : int or mapping of str to int or "auto", optional
        Values of a chunk, by dimension; with them every variable is a Dask array, cut as it
        is stored where nothing is said of a dimension.

    Returns
    -------
    dataset : xarray.Dataset
        Text decoded, elapsed time as numbers. To be closed, or used with ``with``.

    Raises
    ------
    ArchiveError
        If there is no such file, it is not netCDF or damaged, or it has another schema.
    SettingsError
        If Dask is wanted and not installed, or refuses the chunks.
    """
    if not path.is_file():
        raise ArchiveError(f"there is no archive {path}", hint="Run the campaign first.")
    is_sealed = False
    try:
        is_sealed = check_seal(path)
        check_stored(path)
        with _small_cache():
            dataset = xr.open_dataset(
                path, engine="netcdf4", decode_times=False, decode_timedelta=False
            )
    except ArchiveError:
        raise
    except UnicodeEncodeError as error:
        # a ValueError too, but of the name and not of the file
        raise ArchiveError(
            f"{str(path)!a} cannot be given to the netCDF library",
            found=f"a name that {error.encoding} has no letters for",
            needed="a name in the character set of this process",
            hint="Set PYTHONUTF8=1, or take a locale of UTF-8, or rename the folder.",
        ) from error
    except (AttributeError, OSError, RuntimeError, ValueError, TypeError) as error:
        # a TypeError of a scale that is text
        if isinstance(error, OSError) and (error.errno or 0) > 0:  # those of the library are below
            raise ArchiveError(
                f"{path} cannot be read", found=error.strerror or str(error)
            ) from error
        if _OF_DISK.search(str(error)) and is_sealed:
            raise _unreadable(str(path), error) from error
        raise ArchiveError(
            f"{path} is not a netCDF file",
            found=_words(error),
            needed="an archive of a reduced test",
        ) from error
    found = dataset.attrs.get("schema_version")
    if not isinstance(found, str) or found != SCHEMA_VERSION:
        dataset.close()
        raise ArchiveError(
            f"{path} has another schema",
            found="none" if found is None else f"version {str(found)[:40]}",
            needed=f"version {SCHEMA_VERSION}",
            hint="Reduce the test again with this version.",
        )
    try:
        check_form(path, dataset)
    except ArchiveError:
        dataset.close()
        raise
    if chunks is None:
        return dataset
    # what is known to be an archive is opened again, so that a fault is one of the chunks
    dataset.close()
    return _open_in_chunks(path, chunks)


@contextmanager
def _small_cache() -> Iterator[None]:
    """Files that are opened meanwhile keep little of what is read; others are as they were."""
    before = netCDF4.get_chunk_cache()
    netCDF4.set_chunk_cache(_CACHE)
    try:
        yield
    finally:
        netCDF4.set_chunk_cache(*before)


def _open_in_chunks(path: Path, chunks: Chunks) -> xr.Dataset:
    if find_spec("dask") is None:
        raise SettingsError(
            "chunks need Dask",
            found="no package of that name",
            needed="dask",
            hint='Install "mooring-reduction[cluster]", or leave chunks out: values are read '
            "when they are asked for all the same.",
        )
    try:
        return xr.open_dataset(
            path, engine="netcdf4", decode_times=False, decode_timedelta=False, chunks=chunks
        )
    except (AttributeError, TypeError, ValueError, NotImplementedError) as error:
        raise SettingsError(
            "archives cannot be cut in these chunks",
            found=f"{chunks!r}: {str(error).splitlines()[0]}",
            needed='a number of values, or "auto", by the name of a dimension',
        ) from error
