"""Data on disk that do not fit in memory, until they are read again."""

from __future__ import annotations

import errno
import os
from io import FileIO
from tempfile import TemporaryFile

from reduction.record.samples import scratch_folder


class ScratchFile:
    """Data stored one after another on disk, deleted with the object; created on first use."""

    def __init__(self) -> None:
        self._file: FileIO | None = None
        self.n_bytes = 0

    def __del__(self) -> None:
        """Release the disk space."""
        if self._file is not None:
            self._file.close()

    def put(self, content: bytes) -> slice:
        """Store data and return their position; `OSError` if the disk has no room."""
        if self._file is None:
            self._file = TemporaryFile(buffering=0, dir=scratch_folder())
        self._file.seek(self.n_bytes)
        if self._file.write(content) < len(content):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        place = slice(self.n_bytes, self.n_bytes + len(content))
        self.n_bytes = place.stop
        return place

    def get(self, place: slice) -> bytes:
        """Return the data at a position."""
        if self._file is None:
            return b""
        self._file.seek(place.start)
        return self._file.read(place.stop - place.start)
