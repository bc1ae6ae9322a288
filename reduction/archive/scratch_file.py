"""What memory has no room for, put on disk until it is read again."""

from __future__ import annotations

import errno
import os
from io import FileIO
from tempfile import TemporaryFile

from reduction.record.samples import scratch_folder


class ScratchFile:
    """Contents one behind the other on disk, gone with the object; no file until there are any."""

    def __init__(self) -> None:
        self._file: FileIO | None = None
        self.n_bytes = 0

    def __del__(self) -> None:
        """Give the disk back."""
        if self._file is not None:
            self._file.close()

    def put(self, content: bytes) -> slice:
        """Keep a content and give its place; `OSError` where the disk has no room for it."""
        if self._file is None:
            self._file = TemporaryFile(buffering=0, dir=scratch_folder())
        self._file.seek(self.n_bytes)
        if self._file.write(content) < len(content):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        place = slice(self.n_bytes, self.n_bytes + len(content))
        self.n_bytes = place.stop
        return place

    def get(self, place: slice) -> bytes:
        """Return the content at a place."""
        if self._file is None:
            return b""
        self._file.seek(place.start)
        return self._file.read(place.stop - place.start)
