"""Opening an archive: only a file that this version understands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

import netCDF4
import xarray as xr

from reduction.archive.seal import check_seal
from reduction.archive.sound import check_form, check_stored
from reduction.archive.version import SCHEMA_VERSION
from reduction.errors import ArchiveError, SettingsError

__all__ = ["Chunks", "open_archive"]

Chunks = int | Mapping[str, int | Literal["auto"] | tuple[int, ...]]
"""Values of a chunk, or by dimension, as `xarray.open_dataset` takes them."""

_CACHE = 1 << 20
"""Bytes of each variable that the library keeps as they are read: two chunks of an archive. Its own
64 MB hold all that was ever read of a test, beside what is made of it."""


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
    try:
        check_seal(path)
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
    except (OSError, RuntimeError, ValueError, TypeError) as error:  # a scale that is text
        if isinstance(error, OSError) and (error.errno or 0) > 0:  # those of the library are below
            raise ArchiveError(
                f"{path} cannot be read", found=error.strerror or str(error)
            ) from error
        raise ArchiveError(
            f"{path} is not a netCDF file",
            found=str(error).splitlines()[0],
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
