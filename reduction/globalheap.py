"""Global heaps of an HDF5 file, looked at before the library goes through them.

They hold what may be of any length, texts above all, one object behind the other.  The library
walks along the sizes that these state, and never ends where one states that it has none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import BinaryIO

__all__ = ["endless_heap"]

# what stands between the version and the size is not looked at by the library
_SIGNATURE = b"GCOL\1"
_BLOCK = 1 << 16
_FREE = 0  # the index of what is left of a heap
_OFTEN = 1 << 12  # objects
_LEAST = 8  # bytes of an object and the heap around it, however they lie


def endless_heap(
    file: BinaryIO, size_of_lengths: int = 8, *, meanwhile: Callable[[], None] | None = None
) -> str | None:
    """Find a heap that the library would walk along without end.

    Parameters
    ----------
    file : binary file
        An HDF5 file; all of it is searched, so that heaps to which nothing refers count too.
    size_of_lengths : int
        As the file states it. [byte]
    meanwhile : callable, optional
        Called now and then; may raise, to end what takes too long.

    Returns
    -------
    fault : str or None
        Where it stands, or that heaps lie in each other, of which there is no end to look at.

    Raises
    ------
    OSError
        If the file cannot be read.

    Notes
    -----
    HDF5 File Format Specification 3.0, section III.E: a heap begins with "GCOL", version 1, three
    bytes and its size. Each object has its index, a count, four bytes and the size of its data,
    and is padded to eight bytes; index 0 is what is free, whose size is that of all of it. The
    walk of HDF5 2.0.0 does not end where that is zero.
    """
    header, n_bytes = _padded(8 + size_of_lengths), file.seek(0, 2)
    n_left = n_bytes // _LEAST
    for begin in _heaps(file):
        file.seek(begin + 8)
        end = begin + int.from_bytes(file.read(size_of_lengths), "little")
        at = begin + header
        # of a heap that the file does not hold the library says so
        while at + header <= end <= n_bytes:
            if not n_left:
                return f"global heaps that lie in each other, the last at byte {begin:,}"
            n_left -= 1
            if meanwhile is not None and not n_left % _OFTEN:
                meanwhile()
            file.seek(at)
            head = file.read(8 + size_of_lengths)
            index, size = int.from_bytes(head[:2], "little"), int.from_bytes(head[8:], "little")
            needed = size if index == _FREE else header + _padded(size)
            # beyond the end too: a sum of so many bytes may come back to where it was
            if not needed or at + needed > end:
                return f"a global heap at byte {begin:,} that has no end"
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
