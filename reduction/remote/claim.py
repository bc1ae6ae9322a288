"""One run at a time puts products into a folder on the net."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from reduction.address import shown_address
from reduction.remote.faults import attempt, product_fault
from reduction.remote.place import Place, below, connect
from reduction.remote.transfer import remove

__all__ = ["CLAIM_NAME", "claimed"]

CLAIM_NAME = "put.lock"


@contextmanager
def claimed(address: str) -> Iterator[None]:
    """Hold a folder while files are put into it.

    Of several that try at once one makes the file, as far as the store knows "make it where
    there is none": S3, Google and Azure do; elsewhere it is looked at first.

    Parameters
    ----------
    address : str
        Of the folder.

    Raises
    ------
    ArchiveError
        If another run holds it, or it may not be written to.
    """
    name = below(address, CLAIM_NAME)
    place = connect(name)
    if not attempt(lambda: _is_made(place), name, product_fault, doing="written"):
        raise product_fault(
            shown_address(address), "another run puts its products here",
            found=CLAIM_NAME, needed="one run at a time in a folder of products",
            hint="Nothing of this run was put there. Run again; if no other is at work, that one "
            "was killed: delete the file.",
        )  # fmt: skip
    try:
        yield
    finally:
        remove(name)


def _is_made(place: Place) -> bool:
    """Make a file; False where there is one."""
    parent = place.path.rpartition("/")[0]
    if not place.is_whole and parent:
        place.system.makedirs(parent, exist_ok=True)
    try:
        place.system.pipe_file(place.path, b"a run puts its products here\n", mode="create")
    except FileExistsError:
        return False
    return True
