"""Records that are kept, so that a log is read once however often a setting is moved."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

from reduction.ingest.record_of_test import read_record
from reduction.provenance import Source
from reduction.record import Record

__all__ = ["KeptRecords", "Stamp", "stamp_of"]

Stamp = tuple[int, int, int]
Read = tuple[Record, tuple[Source, ...]]


class KeptRecords:
    """A reader for `reduction.batch.survey.survey_log` that remembers the last few logs.

    A record is read again where its files changed, or a setting of the reading did.

    Parameters
    ----------
    most : int
        How many are kept.
    told : callable
        Told of each log that is read.
    """

    def __init__(self, most: int = 3, told: Callable[[str], None] = lambda text: None) -> None:
        self._most = most
        self._kept: OrderedDict[Hashable, Read] = OrderedDict()
        self.told = told

    def __call__(self, files: list[tuple[Path, Any, str]], *, test_id: str, **how: Any) -> Read:
        """As `reduction.ingest.record_of_test.read_record`."""
        read = tuple((path, stamp_of(path), layout.model_dump_json()) for path, layout, _ in files)
        key = (read, test_id, tuple(sorted((name, repr(value)) for name, value in how.items())))
        if key not in self._kept:
            self.told("reading the log")
            self._kept[key] = read_record(files, test_id=test_id, **how)
        self._kept.move_to_end(key)
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return self._kept[key]


def stamp_of(path: Path) -> Stamp:
    """Whatever changes with a file; of one that is not there the reader says so."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):  # the latter of a name that no file can have
        return (0, 0, 0)
    return (found.st_size, found.st_mtime_ns, found.st_ino)
