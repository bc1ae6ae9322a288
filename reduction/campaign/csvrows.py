"""A CSV that a person keeps beside campaign.toml: its header and its filled rows."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path

from reduction.errors import LogError, ReductionError

__all__ = ["read_csv_rows"]


def read_csv_rows(
    path: Path, what: str, *, fault: Callable[..., ReductionError] = LogError
) -> tuple[list[str], Iterator[tuple[int, list[str]]]]:
    """Read a table that is small.

    Parameters
    ----------
    path : pathlib.Path
        UTF-8, with or without a byte-order mark.
    what : str
        For the messages: ``the table of results``.
    fault : callable
        Error of a file and a problem, with ``row``, ``found`` and ``needed``.

    Returns
    -------
    header : list of str
        Without blanks around the names; empty where the file is.
    rows : iterator of (int, list of str)
        Number of the line, the header being 1, and as many cells as the header; lines
        without a filled cell are left out. A row is looked at when it is asked for.

    Raises
    ------
    ReductionError
        From ``fault``, if the file is not text or a row has another number of cells.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise fault(path, f"{what} is not UTF-8 text", found=str(error)) from error
    except OSError as error:
        raise fault(path, f"{what} cannot be read", found=error.strerror or str(error)) from error
    lines = csv.reader(text.splitlines())
    header = [name.strip() for name in next(lines, [])]

    def rows() -> Iterator[tuple[int, list[str]]]:
        for number, cells in enumerate(lines, start=2):
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                raise fault(
                    path, "a row has another number of cells than the header", row=number,
                    found=str(len(cells)), needed=str(len(header)),
                )  # fmt: skip
            yield number, cells

    return header, rows()
