"""A table for a pipe: one line a row, columns that a program can cut, nothing left out."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len

NOTHING = "-"
"""What stands in an empty cell, so that every line has as many columns."""


def plain_table(
    heads: Sequence[str], columns: Sequence[Sequence[str]], *, is_number: Sequence[bool]
) -> str:
    """Return a heading and rows, two spaces or more between the columns.

    Parameters
    ----------
    heads : sequence of str
        One a column; a line end in it counts as a space, as in every cell.
    columns : sequence of sequence of str
        Cells, column by column.
    is_number : sequence of bool
        Which columns stand flush right.

    Examples
    --------
    >>> print(plain_table(["test", "cycles"], [["T-1", "T-10"], ["10", ""]],
    ...     is_number=[False, True]))
    test  cycles
    T-1       10
    T-10       -
    """
    padded = []
    for head, column, is_right in zip(heads, columns, is_number, strict=True):
        # nothing inside a cell looks like the space between two
        cells = [" ".join(cell.split()) or NOTHING for cell in (head, *column)]
        widths = [len(cell) if cell.isascii() else cell_len(cell) for cell in cells]
        size = max(widths)
        spaces = [" " * (size - width) for width in widths]
        padded.append(
            [
                space + cell if is_right else cell + space
                for cell, space in zip(cells, spaces, strict=True)
            ]
        )
    return "\n".join("  ".join(row).rstrip() for row in zip(*padded, strict=True))
