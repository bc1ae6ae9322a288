"""tests.csv: one row a test, over the campaign's ``[defaults]``."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from reduction.campaign.faults import faults_of
from reduction.campaign.model import Identifier, TestSection
from reduction.errors import LogError

__all__ = ["read_test_table"]

_LISTS = ("specimens", "target_strain")
_WHOLE = ("order", "n_cycles")


def _cells(path: Path, row: int, cells: dict[str, str]) -> dict[str, Any]:
    """The filled cells of one row, as TOML would have given them."""
    table: dict[str, Any] = {}
    for name, cell in cells.items():
        text = cell.strip()
        if not text or name == "id":
            continue
        if name in _LISTS:
            table[name] = [entry.strip() for entry in text.split(";")]
        elif name in ("method", "marks"):
            table.setdefault("strain", {})[name] = text
        elif name in _WHOLE:
            if not text.lstrip("-").isdigit():
                raise LogError(
                    path, f"{name} is not a whole number", row=row, channel=name,
                    found=repr(text), needed="a whole number",
                )  # fmt: skip
            table[name] = int(text)
        else:
            table[name] = text
    return table


def read_test_table(path: Path) -> dict[str, TestSection]:
    """Read a table of tests.

    Parameters
    ----------
    path : pathlib.Path
        CSV with at least ``id`` and ``file``; other columns are keys of ``[tests.ID]``
        (lists parted by ``;``), and ``method`` and ``marks`` are those of ``strain``.

    Returns
    -------
    tests : dict of str to TestSection
        By id, in the order of the table; an empty cell means: as in ``[defaults]``.

    Raises
    ------
    LogError
        With the row, if a row cannot be used.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise LogError(path, "the table of tests is not UTF-8 text", found=str(error)) from error
    rows = csv.reader(text.splitlines())
    header = [name.strip() for name in next(rows, [])]
    if "id" not in header or "file" not in header or len(set(header)) != len(header):
        raise LogError(
            path, "the table of tests has no usable header", row=1, found=", ".join(header),
            needed="id, file and keys of [tests.ID], each once",
        )  # fmt: skip
    tests: dict[str, TestSection] = {}
    identifier = TypeAdapter(Identifier)
    for number, line in enumerate(rows, start=2):
        if not any(cell.strip() for cell in line):
            continue
        if len(line) != len(header):
            raise LogError(
                path, "a row has another number of cells than the header", row=number,
                found=str(len(line)), needed=str(len(header)),
            )  # fmt: skip
        cells = dict(zip(header, line, strict=True))
        name = cells["id"].strip()
        if name in tests:
            raise LogError(path, "a test stands twice", row=number, channel="id", found=repr(name))
        filled = _cells(path, number, cells)
        try:
            identifier.validate_python(name)
            tests[name] = TestSection.model_validate(filled)
        except ValidationError as error:
            first, *others = faults_of(error, filled)
            raise LogError(
                path, "a row of tests cannot be used", row=number, channel=first.place or "id",
                found=first.found or None, needed=first.needed.removeprefix("Input should be "),
                hint=f"Also {', '.join(map(str, others))}." if others else None,
            ) from error  # fmt: skip
    return tests
