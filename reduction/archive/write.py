"""Writing products, each whole or not at all."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

import xarray as xr

from reduction.archive.netcdf import write_netcdf
from reduction.archive.whole import remove_abandoned, whole_file
from reduction.errors import ArchiveError


def write_archive(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset of `reduction.archive.dataset.to_dataset` as one netCDF file.

    Parameters
    ----------
    dataset : xarray.Dataset
        With encoding.
    path : pathlib.Path
        The file; one that is there is replaced at the very end, or kept.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    try:
        with whole_file(path) as part:
            write_netcdf(dataset, part)
    except ArchiveError:
        raise
    except (OSError, RuntimeError) as error:
        raise _not_written(path, error) from error


def write_whole(path: Path, text: str) -> None:
    """Write a text file in UTF-8, line ends as they are in ``text``, whole or not at all.

    Parameters
    ----------
    path : pathlib.Path
        The file; one that is there is replaced at the very end, or kept.
    text : str
        All of it.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    with appended_whole(path) as append:
        append(text)


@contextmanager
def appended_whole(path: Path) -> Iterator[Callable[[str], None]]:
    """Give what adds text to a file that appears whole when the block ends well, or not at all.

    Parameters
    ----------
    path : pathlib.Path
        The file, in UTF-8, line ends as they are in the text; one that is there is replaced at
        the very end, or kept.

    Yields
    ------
    append : callable
        Of one text, which is written behind the ones before.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    is_in_block = False
    remove_abandoned(path)
    try:
        with whole_file(path) as part:
            is_in_block = True
            yield partial(_append, part, path)
            is_in_block = False
    except OSError as error:
        if is_in_block or isinstance(error, ArchiveError):  # says nothing of this file, or all
            raise
        raise _not_written(path, error) from error


def _append(part: Path, path: Path, text: str) -> None:
    try:
        with part.open("a", encoding="utf-8", newline="") as file:
            file.write(text)
    except OSError as error:
        raise _not_written(path, error) from error


def _not_written(path: Path, error: Exception) -> ArchiveError:
    found = getattr(error, "strerror", None)
    if not isinstance(found, str) or (getattr(error, "errno", None) or 0) < 0:
        # numbers of the netCDF library, which does not pass on what the system said
        with suppress(OSError):
            free = shutil.disk_usage(path.parent).free
            found = f"{error}, with {free / 1e6:.0f} MB free on the disk"
    return ArchiveError(
        f"{path} cannot be written",
        found=found or str(error),
        hint="What was there before is kept. Check the folder and the space on the disk.",
    )
