"""Archives that several steps of a run read: from the disk once, and then from memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import xarray as xr

from reduction.archive.open import reading

__all__ = ["ArchivesInMemory"]

_MOST = 64  # archives, each of which takes 1.5 MB beside its values
_LARGEST = 8_000_000  # bytes of values of one, unpacked
_ROOM = 64_000_000  # and of all
_Stamp = tuple[int, int, int]


class ArchivesInMemory:
    """Opens archives; those that are small are read whole, and given again without the disk.

    What is kept is what was kept first, so that one pass after the other over more archives than
    there is room for finds some of them each time.

    Notes
    -----
    To open an archive takes longer than to read all of a small one, since the library looks at
    each of its 350 variables; the steps of a run read each five times.
    """

    def __init__(self) -> None:
        self._kept: dict[Path, tuple[_Stamp, xr.Dataset]] = {}

    @contextmanager
    def reading(self, path: Path) -> Iterator[xr.Dataset]:
        """Give an archive for a block, as `reduction.archive.open.reading` does.

        Parameters
        ----------
        path : pathlib.Path
            A file that `write_archive` wrote; it is read anew where it is another one by now.

        Yields
        ------
        dataset : xarray.Dataset
            A copy in which variables may be added; values may not be changed.

        Raises
        ------
        ArchiveError
            As `reduction.archive.open.reading`.
        """
        stamp, kept = self._kept.get(path, (None, None))
        if kept is None or stamp != _stamp(path):
            # from before it is opened: one that is replaced meanwhile is read anew the next time
            stamp, kept = _stamp(path), None
            self._kept.pop(path, None)
            with reading(path) as archive:
                if stamp is not None and self._has_room(archive.nbytes) and _is_read(archive):
                    kept = _unchangeable(archive)
                    self._kept[path] = (stamp, kept)
                else:
                    yield archive
                    return
        yield kept.copy()

    def _has_room(self, n_bytes: int) -> bool:
        held = sum(archive.nbytes for _, archive in self._kept.values())
        return len(self._kept) < _MOST and n_bytes <= min(_LARGEST, _ROOM - held)


def _is_read(archive: xr.Dataset) -> bool:
    try:
        archive.load()
    except (AttributeError, OSError, RuntimeError):
        # perhaps of a variable that no step asks for; one that does is told
        return False
    return True


def _unchangeable(archive: xr.Dataset) -> xr.Dataset:
    """A step that would change a value for the steps after it fails."""
    for variable in archive.variables.values():
        variable.values.flags.writeable = False
        for attribute in variable.attrs.values():
            if isinstance(attribute, np.ndarray):
                attribute.flags.writeable = False
    return archive


def _stamp(path: Path) -> _Stamp | None:
    try:
        found = path.stat()
    except OSError:  # which opening it tells
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
