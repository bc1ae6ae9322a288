"""Rows of a CSV file as dictionaries."""

import csv


def csv_rows(path, comment=None):
    """Rows by the names of the first line; lines that begin as a comment does are left out."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = (line for line in file if comment is None or not line.startswith(comment))
        return list(csv.DictReader(lines))
