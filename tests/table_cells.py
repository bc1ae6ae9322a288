"""Rows of a table as cells, read back from its text."""

import csv
import io

from reduction.archive.csv_columns import _text_of, table_blocks
from reduction.quantities.row import TEXT


def table_rows(archive, table):
    """Numbers as numbers, None where there is none; text as it stands in the file."""
    text = "".join(_text_of(one, header=False) for one in table_blocks(archive, table))
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
