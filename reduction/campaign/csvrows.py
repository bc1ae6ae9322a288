"""A CSV that a person keeps beside campaign.toml: its header and its filled rows."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path

from reduction.campaign.textfiles import read_small_text
from reduction.errors import LogError, ReductionError
from reduction.visible import bare_cell, cut


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
        text = read_small_text(path)
    except LogError as error:
        raise fault(path, error.problem, found=error.found, needed=error.needed) from error
    except UnicodeDecodeError as error:
        raise fault(path, f"{what} is not UTF-8 text", found=str(error)) from error
    except OSError as error:
        raise fault(path, f"{what} cannot be read", found=error.strerror or str(error)) from error
    lines = split_rows(text)

    def split(number: int, line: str) -> list[str]:
        cells = split_row(line)
        if cells is None:
            raise fault(
                path, f"a row of {what} cannot be parted into cells", row=number,
                found=repr(cut(line, 60)),
                needed="one line a row, every quote closed in it, no cell of 131,072 characters",
            )  # fmt: skip
        return cells

    header = [name.strip() for name in split(1, lines[0])]

    def rows() -> Iterator[tuple[int, list[str]]]:
        for number, line in enumerate(lines[1:], start=2):
            cells = split(number, line)
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                raise fault(
                    path, "a row has another number of cells than the header", row=number,
                    found=str(len(cells)), needed=str(len(header)),
                )  # fmt: skip
            yield number, cells

    return header, rows()


def split_rows(text: str) -> list[str]:
    """Lines of a table as an editor counts them; one at least."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def split_row(line: str, delimiter: str = ",") -> list[str] | None:
    """Cells of one line; None where a quote is not closed in it, or a cell is too long.

    Parameters
    ----------
    line : str
        Without its line end.
    delimiter : str
        What parts the cells.

    Returns
    -------
    cells : list of str or None
        A quote that goes on into the next line would swallow the rows below without a word.  An
        apostrophe that keeps a spreadsheet program from a formula is taken off.

    Examples
    --------
    >>> split_row('T-1,"a, b",2')
    ['T-1', 'a, b', '2']
    >>> split_row('T-1,"a, b,2') is None
    True
    """
    try:
        cells = next(csv.reader([line], delimiter=delimiter, strict=True), [])
    except csv.Error:
        return None
    return [bare_cell(cell) for cell in cells]
