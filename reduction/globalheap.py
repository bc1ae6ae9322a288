"""Texts of any length in an HDF5 file, looked at before the library goes to them.

They stand in global heaps, objects one behind the other.  The library walks along the sizes that
these state, and never ends where one states that it has none.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import BinaryIO

__all__ = ["MOST_OBJECTS", "endless_heap"]

MOST_OBJECTS = 2_000_000
"""Texts that are looked at, some seconds of work; a log has as many as it has columns. [1]"""

_SIGNATURE = b"GCOL\1\0\0\0"
_BLOCK = 1 << 20
_FREE = 0  # the index of what is left of a heap


def endless_heap(
    file: BinaryIO, size_of_lengths: int = 8, *, most: int = MOST_OBJECTS
) -> str | None:
    """Find a heap that the library would walk along without end.

    Parameters
    ----------
    file : binary file
        An HDF5 file; all of it is searched.
    size_of_lengths : int
        As the file states it. [byte]
    most : int
        Objects that are looked at. [1]

    Returns
    -------
    fault : str or None
        Where it stands, or that there are too many to look at.

    Raises
    ------
    OSError
        If the file cannot be read.

    Notes
    -----
    HDF5 File Format Specification 3.0, section III.E: a heap begins with "GCOL", version 1, three
    zeros and its size. Each object has its index, a count, four bytes and the size of its data,
    and is padded to eight bytes; index 0 is what is free, whose size is that of all of it. The
    walk of HDF5 2.0.0 does not end where that is zero.
    """
    header, n_left, n_bytes = _padded(8 + size_of_lengths), most, file.seek(0, 2)
    for begin in _heaps(file):
        file.seek(begin + 8)
        end = begin + int.from_bytes(file.read(size_of_lengths), "little")
        at = begin + header
        # of a heap that the file does not hold the library says so
        while at + header <= end <= n_bytes:
            if not n_left:
                return f"more than {most:,} texts of any length"
            n_left -= 1
            file.seek(at)
            head = file.read(8 + size_of_lengths)
            index, size = int.from_bytes(head[:2], "little"), int.from_bytes(head[8:], "little")
            needed = size if index == _FREE else header + _padded(size)
            # beyond the end too: a sum of so many bytes may come back to where it was
            if not needed or at + needed > end:
                return f"a heap of texts at byte {begin:,} that has no end"
            at += needed
    return None


def _padded(n_bytes: int) -> int:
    return -(-n_bytes // 8) * 8


def _heaps(file: BinaryIO) -> Iterator[int]:
    """Places at which a heap may begin; the file may be moved in between."""
    before, place = b"", 0
    while file.seek(place) == place and (part := file.read(_BLOCK)):
        text = before + part
        at = text.find(_SIGNATURE)
        while at >= 0:
            yield place - len(before) + at
            at = text.find(_SIGNATURE, at + 1)
        place += len(part)
        before = text[1 - len(_SIGNATURE) :]
