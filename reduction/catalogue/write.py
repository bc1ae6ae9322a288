"""The answer as a file: CSV with the unit in each header, or Parquet with it beside each column."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow  # type: ignore[import-untyped]
import pyarrow.csv  # type: ignore[import-untyped]
import pyarrow.parquet  # type: ignore[import-untyped]

from reduction.archive.whole import whole_file
from reduction.errors import ArchiveError, SettingsError
from reduction.visible import safe_cell
from reduction.vocabulary import QUANTITIES

_SPREAD = "_standard_uncertainty"


def unit_of(name: str) -> str:
    """Unit of a column; empty for a text.

    Examples
    --------
    >>> [unit_of(name) for name in ("test", "diameter", "diameter_standard_uncertainty")]
    ['', 'm', 'm']
    """
    row = QUANTITIES.get(name) or QUANTITIES.get(name.removesuffix(_SPREAD))
    return "1" if row is None else row.unit


def meaning_of(name: str) -> str:
    """What a column holds, in words."""
    row = QUANTITIES.get(name)
    if row is not None:
        return row.long_name
    base = QUANTITIES.get(name.removesuffix(_SPREAD))
    return name if base is None else f"standard uncertainty (k=1) of {base.long_name}"


def check_ending(path: Path) -> None:
    """Refuse a file that is neither CSV nor Parquet, before the work is done.

    Raises
    ------
    SettingsError
        If the name ends otherwise.
    """
    if path.suffix.lower() not in (".csv", ".parquet"):
        raise SettingsError(
            "--export does not know the ending of the file",
            found=repr(path.name),
            needed="FILE.csv or FILE.parquet",
        )


def write_answer(table: Any, path: Path) -> None:
    """Write a table of `reduction.catalogue.query.answer`, SI, whole or not at all.

    Parameters
    ----------
    table : pyarrow.Table
        Its columns have names of the vocabulary.
    path : pathlib.Path
        Ends in ``.csv`` or ``.parquet``.

    Raises
    ------
    SettingsError
        If the name ends otherwise.
    ArchiveError
        If the disk refuses.
    """
    check_ending(path)
    try:
        with whole_file(path) as part:
            if path.suffix.lower() == ".csv":
                units = map(unit_of, table.column_names)
                heads = [
                    f"{name} [{unit}]" if unit else name
                    for name, unit in zip(table.column_names, units, strict=True)
                ]
                options = pyarrow.csv.WriteOptions(quoting_style="needed")
                pyarrow.csv.write_csv(_safe(table).rename_columns(heads), part, options)
            else:
                fields = [
                    one.with_metadata(
                        {"units": unit_of(one.name), "long_name": meaning_of(one.name)}
                    )
                    for one in table.schema
                ]
                pyarrow.parquet.write_table(table.cast(pyarrow.schema(fields)), part)
    except ArchiveError:
        raise
    except OSError as error:
        raise ArchiveError(
            f"{path} cannot be written",
            found=getattr(error, "strerror", None) or str(error),
            hint="What was there before is kept.",
        ) from error


def _safe(table: Any) -> Any:
    """The table with no text that a spreadsheet program takes for a formula."""
    for place, column in enumerate(table.schema):
        if pyarrow.types.is_string(column.type) or pyarrow.types.is_large_string(column.type):
            texts = [None if one is None else safe_cell(one) for one in table[place].to_pylist()]
            table = table.set_column(place, column, pyarrow.array(texts, column.type))
    return table
