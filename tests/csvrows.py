"""Rows of a CSV file as dictionaries, and what is said of its columns."""

import csv


def csv_rows(path, comment=None):
    """Rows by the names of the first line; lines that begin as a comment does are left out."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = (line for line in file if comment is None or not line.startswith(comment))
        return list(csv.DictReader(lines))


def hold_columns_explained(table, header, columns):
    """Each column of a table has a meaning, its unit, and an uncertainty or the reason why not."""
    explained = {(row["table"], row["column"]): row for row in columns}
    for name, after in zip(header, [*header[1:], ""], strict=True):
        row = explained[table, name]
        assert row["meaning"], (table, name)
        stem = name.partition(" [")[0]
        has_uncertainty = after.startswith(f"{stem}_standard_uncertainty [")
        assert has_uncertainty != bool(row["no_uncertainty"]), (table, name)
        assert (row["unit"] not in ("", "1")) <= (f"[{row['unit']}]" in name), (table, name)
