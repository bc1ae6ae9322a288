"""Rows of a table as cells, read back from its text."""

import csv
import io

from reduction.archive.csv_columns import _cells, _text_of, column_blocks
from reduction.quantities.row import TEXT


def text_of_columns(*columns):
    """Columns as the text of a table without its header."""
    return _text_of(zip(*map(_cells, columns), strict=True))


def table_rows(archive, table):
    """Numbers as numbers, None where there is none; text as it stands in the file."""
    blocks = column_blocks(archive, archive.variables, table)
    text = "".join(text_of_columns(*own) for _, own in blocks)
    rows = csv.reader(io.StringIO(text, newline=""))
    variables = [column.variable for column in table.columns]
    return [
        [_cell(field, variable) for field, variable in zip(row, variables, strict=True)]
        for row in rows
    ]


def _cell(field, variable):
    if variable.flags or variable.dtype == TEXT:
        return field
    if not field:
        return None
    return float(field) if variable.dtype == "f8" else int(field)
