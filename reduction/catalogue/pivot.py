"""Numbers beside the conditions of their tests: one row a place, one column a quantity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from reduction.catalogue.columns import CONDITIONS, NUMBER
from reduction.catalogue.file import Catalogue
from reduction.errors import SettingsError

_OWN = ("row", *NUMBER)


def rows_with(catalogue: Catalogue, tests: pd.DataFrame, asked: Sequence[str]) -> pd.DataFrame:
    """Rows of tests with the numbers that are asked for.

    Parameters
    ----------
    catalogue : Catalogue
        With those numbers.
    tests : pandas.DataFrame
        Rows of ``catalogue.tests`` that count.
    asked : sequence of str
        Quantities; without one each specimen of each test is a row.

    Returns
    -------
    table : pandas.DataFrame
        `CONDITIONS`, a column for each dimension, each quantity and its standard uncertainty, and
        ``row`` of ``catalogue.tests``; in the order of tests, places as in their archives.
    """
    values = catalogue.numbers[catalogue.numbers["row"].isin(tests.index)]
    parts = {name: _numbers_of(values, name) for name in asked}
    of_tests = {name: part for name, part in parts.items() if not _places(part, name)}
    placed = [part for name, part in parts.items() if name not in of_tests]
    listed = catalogue.tests.index[_is_listed(catalogue.tests)].intersection(tests.index)
    rows = pd.DataFrame({"row": [] if asked else listed}, dtype=np.int64)
    if placed:
        together = pd.concat(placed, ignore_index=True)
        numbers = [name for one in asked for name in _columns_of(one) if name in together]
        keys = [name for name in together.columns if name not in numbers]
        rows = together.groupby(keys, sort=False, dropna=False)[numbers].max().reset_index()
    places = [name for name in rows.columns if name != "row" and not _is_number(name, asked)]
    if of_tests:
        # one row without place for tests that have none
        known = pd.concat([one.dropna(subset=name)["row"] for name, one in of_tests.items()])
        others = pd.DataFrame({"row": sorted(set(known) - set(rows["row"]))}, dtype=np.int64)
        rows = pd.concat([rows, others], ignore_index=True) if len(rows) else others
    for name, part in of_tests.items():
        rows = _beside(rows, part, name)
    if asked:
        rows = rows.dropna(subset=list(asked), how="all")
    rows = rows.reindex(columns=["row", *places, *(n for name in asked for n in _columns_of(name))])
    rows = rows.sort_values("row", kind="stable", ignore_index=True)
    # a condition that is asked for as a quantity stands once, with its uncertainty
    names = [name for name in CONDITIONS if name not in asked]
    about = tests.loc[rows["row"], names].reset_index(drop=True)
    return pd.concat([about, rows], axis=1)


def with_quantity(table: pd.DataFrame, catalogue: Catalogue, name: str) -> pd.DataFrame:
    """The same rows with a quantity of their tests.

    Raises
    ------
    SettingsError
        If the quantity stands in several places of a test.
    """
    part = _numbers_of(catalogue.numbers, name)
    places = _places(part, name)
    if places:
        raise SettingsError(
            f"'{name}' stands in several places of a test",
            found=f"one number for each {' and '.join(places)}",
            needed=f"--quantity {name}, so that each place is a row",
        )
    return _beside(table, part, name)


def _numbers_of(values: pd.DataFrame, name: str) -> pd.DataFrame:
    """Numbers of a quantity with their places, under its names."""
    part = values[values["quantity"] == name]
    places = [one for one in part.columns if one not in _OWN and part[one].notna().any()]
    part = part[["row", *places, "value", "standard_uncertainty"]]
    return part.rename(columns=dict(zip(NUMBER[1:], _columns_of(name), strict=True)))


def _places(part: pd.DataFrame, name: str) -> list[str]:
    """Dimensions along which the numbers stand."""
    return [one for one in part.columns if one not in ("row", *_columns_of(name))]


def _columns_of(name: str) -> tuple[str, str]:
    return name, f"{name}_standard_uncertainty"


def _is_number(name: str, asked: Sequence[str]) -> bool:
    return any(name in _columns_of(one) for one in asked)


def _is_listed(tests: pd.DataFrame) -> NDArray[np.bool_]:
    """A row for each specimen, and for each archive that has none."""
    is_whole = tests["is_whole"].to_numpy(bool)
    # the row of the whole stands before those of its specimens
    listed: NDArray[np.bool_] = ~is_whole | np.append(is_whole[1:], True)[: is_whole.size]
    return listed


def _beside(rows: pd.DataFrame, part: pd.DataFrame, name: str) -> pd.DataFrame:
    """Numbers of tests beside each of their rows."""
    of_row = part.set_index("row")
    return rows.assign(**{one: rows["row"].map(of_row[one]) for one in _columns_of(name)})
