"""Tables of a campaign: are they what the archives give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from reduction.archive.inmemory import ArchivesInMemory
from reduction.errors import ArchiveError
from reduction.tables.write import write_tables
from reduction.verify.finding import Finding

__all__ = ["check_tables"]

_AGAIN = "Run the campaign again: its tables are made from the archives each time."
_BLOCK = 1 << 20


def check_tables(
    folder: Path, archives: Sequence[Path], products: Mapping[str, Path]
) -> tuple[int, list[Finding]]:
    """Make the tables again in another place, and compare them byte for byte.

    Parameters
    ----------
    folder : pathlib.Path
        Of the products; its tables lie in ``tables``.
    archives : sequence of pathlib.Path
        Of tests, each of which can be read.
    products : mapping of str to pathlib.Path
        Archives of the whole campaign by name.

    Returns
    -------
    n_tables : int
        Tables that the archives give.
    findings : list of Finding
        Those that are missing, others, or too many.
    """
    with TemporaryDirectory(prefix="reduction-verify-") as place:
        try:
            made = write_tables(
                archives, Path(place), opener=ArchivesInMemory().reading, **products
            )
        except ArchiveError as error:
            return 0, [Finding("tables", "not_compared", "they cannot be made again", str(error))]
        compared = (_compared(path, folder / "tables" / path.name) for path in made)
        findings = [one for one in compared if one is not None]
    names = {path.name for path in made}
    findings += [
        Finding(f"tables/{path.name}", "stray", "no archive of this campaign fills it", hint=_AGAIN)
        for path in sorted((folder / "tables").glob("*.csv"))
        if path.name not in names
    ]
    return len(made), findings


def _compared(made: Path, there: Path) -> Finding | None:
    name = f"tables/{there.name}"
    if not there.exists():
        return Finding(name, "missing", "the archives fill it and it is not there", hint=_AGAIN)
    try:
        line = _first_other_line(made, there)
    except OSError as error:
        return Finding(name, "damaged", "it cannot be read", error.strerror or str(error))
    if line is None:
        return None
    return Finding(
        name, "table", "it is not what the archives give", f"another line {line}", hint=_AGAIN
    )


def _first_other_line(made: Path, there: Path) -> int | None:
    """Number of the first line that differs; None where every byte is the same."""
    n_lines = 1
    with made.open("rb") as one, there.open("rb") as other:
        while (left := one.read(_BLOCK)) == (right := other.read(_BLOCK)):
            if not left:
                return None
            n_lines += left.count(b"\n")
    same = next(
        (place for place, (a, b) in enumerate(zip(left, right, strict=False)) if a != b),
        min(len(left), len(right)),
    )
    return n_lines + left[:same].count(b"\n")
