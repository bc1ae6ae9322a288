"""The last line of an archive: a sum over all of the file before it, by which damage is seen."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from reduction.errors import ArchiveError

__all__ = ["check_seal", "has_seal", "write_seal"]

_BLOCK = 1 << 20
_WORDS = b"\nsha256 of the bytes before this line: "
_LENGTH = len(_WORDS) + 64 + 1
_SEAL = re.compile(re.escape(_WORDS) + rb"([0-9a-f]{64})\n")


def write_seal(path: Path) -> None:
    """Add the sum to a file that is whole.

    Parameters
    ----------
    path : pathlib.Path
        An archive without one.

    Raises
    ------
    OSError
        If the disk refuses.

    Notes
    -----
    A netCDF-4 file ends where its own first block says, and what stands behind is passed over
    by the library. A program that changes the file in place cuts it off; a copy has it.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "T-1.nc"
    ...     _ = path.write_bytes(b"abc")
    ...     write_seal(path)
    ...     print(path.read_bytes()[-65:-1].decode())
    ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad
    """
    sum_of_all = _sum(path, path.stat().st_size)
    with path.open("ab") as file:
        file.write(_WORDS + sum_of_all.encode() + b"\n")


def has_seal(path: Path) -> bool:
    """Whether a file ends with a sum; one that another program wrote or changed does not.

    Parameters
    ----------
    path : pathlib.Path
        A file.

    Returns
    -------
    is_sealed : bool
        The sum is not looked at.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    return _stated(path) is not None


def check_seal(path: Path) -> bool:
    """Compare a file with the sum at its end, where it has one.

    Parameters
    ----------
    path : pathlib.Path
        An archive.

    Returns
    -------
    is_sealed : bool
        Whether it has one, which is then the right one.

    Raises
    ------
    ArchiveError
        If a byte is not as it was written.
    OSError
        If the file cannot be read.
    """
    stated = _stated(path)
    if stated is None:
        return False
    found = _sum(path, path.stat().st_size - _LENGTH)
    if found != stated:
        raise ArchiveError(
            f"{path} is damaged: it is not as it was written",
            found=f"sha256 {found[:16]}... of its bytes",
            needed=f"{stated[:16]}..., which stands at its end",
            hint="Take a copy that is whole, or reduce the campaign again.",
        )
    return True


def _stated(path: Path) -> str | None:
    """The sum at the end of a file; None where there is none."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        if size < _LENGTH:
            return None
        file.seek(size - _LENGTH)
        found = _SEAL.fullmatch(file.read(_LENGTH))
    return None if found is None else found[1].decode()


def _sum(path: Path, length: int) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while length > 0 and (part := file.read(min(_BLOCK, length))):
            digest.update(part)
            length -= len(part)
    return digest.hexdigest()
