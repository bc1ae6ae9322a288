"""Numbers beside the conditions of their tests: one row a place, one column a quantity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow  # type: ignore[import-untyped]
from numpy.typing import NDArray

from reduction.catalogue.columns import CONDITIONS
from reduction.catalogue.index import Index
from reduction.errors import SettingsError

__all__ = ["rows_with", "with_quantity"]

_OF_VALUES = ("quantity", "row", "value", "standard_uncertainty")


def rows_with(index: Index, fits: NDArray[np.bool_], asked: Sequence[str]) -> Any:
    """Rows of tests with the numbers that are asked for.

    Parameters
    ----------
    index : Index
        With those numbers.
    fits : NDArray of bool
        Which rows of ``index.tests`` count, shape (n_rows,).
    asked : sequence of str
        Quantities; without one each specimen of each test is a row.

    Returns
    -------
    table : pyarrow.Table
        `CONDITIONS`, a column for each dimension, each quantity and its standard uncertainty, and
        ``row`` of ``index.tests``; in the order of tests, places as in their archives.
    """
    parts = {name: _numbers_of(index, name, fits) for name in asked}
    of_tests = [name for name, part in parts.items() if not _places(part)]
    parts |= {name: parts[name].filter(parts[name]["value"].is_valid()) for name in of_tests}
    placed = [name for name in asked if name not in of_tests]
    if not asked:
        rows = pyarrow.table({"row": np.flatnonzero(fits & _is_listed(index.tests))})
    else:
        rows = _pivoted([_named(parts[name], name) for name in placed], of_tests, parts)
    for name in of_tests:
        rows = _beside(rows, parts[name], name)
    places = [name for name in rows.column_names if name != "row" and not _is_number(name, asked)]
    if asked:
        known = [rows[name].is_valid().to_numpy() for name in asked]
        rows = rows.filter(pyarrow.array(np.any(known, axis=0)))
    rows = rows.sort_by("row")  # stable
    tests = index.tests.take(rows["row"])
    # a condition that is asked for as a quantity stands once, with its uncertainty
    columns = {name: tests[name] for name in CONDITIONS if name not in asked}
    columns |= {name: rows[name] for name in places}
    for name in asked:
        columns |= {one: rows[one] for one in _columns_of(name)}
    return pyarrow.table(columns | {"row": rows["row"]})


def with_quantity(table: Any, index: Index, name: str) -> Any:
    """The same rows with a quantity of their tests.

    Raises
    ------
    SettingsError
        If the quantity stands in several places of a test.
    """
    part = _numbers_of(index, name, np.ones(index.tests.num_rows, bool))
    places = _places(part)
    if places:
        raise SettingsError(
            f"'{name}' stands in several places of a test",
            found=f"one number for each {' and '.join(places)}",
            needed=f"--quantity {name}, so that each place is a row",
        )
    return _beside(table, part, name)


def _numbers_of(index: Index, name: str, fits: NDArray[np.bool_]) -> Any:
    """Rows of the numbers of a quantity in tests that count."""
    part = index.numbers_of(name)
    return part.filter(pyarrow.array(fits[part["row"].to_numpy()]))


def _places(part: Any) -> list[str]:
    """Dimensions along which the numbers stand."""
    names = [name for name in part.column_names if name not in _OF_VALUES]
    return [name for name in names if part[name].null_count < part.num_rows]


def _columns_of(name: str) -> tuple[str, str]:
    return name, f"{name}_standard_uncertainty"


def _is_number(name: str, asked: Sequence[str]) -> bool:
    return any(name in _columns_of(one) for one in asked)


def _is_listed(tests: Any) -> NDArray[np.bool_]:
    """A row for each specimen, and for each archive that has none."""
    is_whole = tests["is_whole"].to_numpy()
    # the row of the whole stands before those of its specimens
    is_alone = is_whole & np.append(is_whole[1:], True)
    listed: NDArray[np.bool_] = ~is_whole | is_alone
    return listed


def _named(part: Any, name: str) -> Any:
    """Numbers with their places, under the names of the quantity."""
    value, spread = _columns_of(name)
    columns = {one: part[one] for one in ("row", *_places(part))}
    return pyarrow.table(columns | {value: part["value"], spread: part["standard_uncertainty"]})


def _pivoted(placed: Sequence[Any], of_tests: Sequence[str], parts: dict[str, Any]) -> Any:
    """One row for each place of each test; one without place for tests that have none."""
    rows = pyarrow.table({"row": pyarrow.array([], pyarrow.int32())})
    if placed:
        together = pyarrow.concat_tables(placed, promote_options="default")
        numbers = {name for one in placed for name in one.column_names[-2:]}
        keys = [name for name in together.column_names if name not in numbers]
        names = [name for name in together.column_names if name in numbers]
        grouped = together.group_by(keys, use_threads=False)
        rows = grouped.aggregate([(name, "max") for name in names]).select(
            [*keys, *(f"{name}_max" for name in names)]
        )
        rows = rows.rename_columns([*keys, *names])
    known = set(rows["row"].to_pylist())
    others = {row for name in of_tests for row in parts[name]["row"].to_pylist()} - known
    more = pyarrow.table({"row": pyarrow.array(sorted(others), pyarrow.int32())})
    return pyarrow.concat_tables([rows, more], promote_options="default")


def _beside(rows: Any, part: Any, name: str) -> Any:
    """Numbers of tests beside each of their rows."""
    size = 1 + max([*rows["row"].to_pylist(), *part["row"].to_pylist()], default=-1)
    at = rows["row"].to_numpy()
    for column, of_index in zip(_columns_of(name), _OF_VALUES[2:], strict=True):
        values = np.full(size, np.nan)
        values[part["row"].to_numpy()] = part[of_index].to_numpy()
        rows = rows.append_column(
            column, pyarrow.array(values[at], pyarrow.float64(), from_pandas=True)
        )
    return rows
