"""A question to the catalogue: which tests, under which conditions, which numbers."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow  # type: ignore[import-untyped]
from numpy.typing import NDArray

from reduction.catalogue.columns import column_type, standing_for
from reduction.catalogue.condition import Condition
from reduction.catalogue.file import Catalogue
from reduction.catalogue.pivot import rows_with, with_quantity
from reduction.errors import SettingsError
from reduction.vocabulary import QUANTITIES

_WORD = re.compile(r"[\w.]+")
# a value that came by way of another unit is not the same to the last bit
_ALIKE = 1e-9
_COMPARE: Final[dict[str, Callable[[Any, float], NDArray[np.bool_]]]] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "=": lambda values, value: np.isclose(values, value, rtol=_ALIKE, atol=0.0),
    "!=": lambda values, value: ~np.isclose(values, value, rtol=_ALIKE, atol=0.0),
}


@dataclass(frozen=True)
class Query:
    """What is asked.

    Parameters
    ----------
    names : dict of str to tuple of str
        Column (``campaign``, ``test``, ``test_kind``, ``specimen``) to patterns with ``*``, ``?``
        and ``[...]``; one of them has to fit, in any case of letters.
    words : dict of str to str
        Column (``medium``, ``specimen_material``, ...) to words, each of which begins a word
        of the text.
    synthetic : bool, optional
        Only synthetic data, or only measured data.
    where : tuple of Condition
        All have to hold; a number that is missing fits none.
    quantity : tuple of str
        Numbers that are shown; a row needs one of them.
    by_cycle : bool
        A quantity of the cycles is not its mean over the test, but that of each cycle kept.
    sort : tuple of str
        Columns by which rows are sorted.
    descending : bool
        From the greatest.
    limit : int, optional
        Rows that are given at most.
    """

    names: dict[str, tuple[str, ...]] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)
    synthetic: bool | None = None
    where: tuple[Condition, ...] = ()
    quantity: tuple[str, ...] = ()
    by_cycle: bool = False
    sort: tuple[str, ...] = ()
    descending: bool = False
    limit: int | None = None

    @property
    def asked(self) -> tuple[str, ...]:
        """Quantities by the names of the catalogue."""
        names = self.quantity if self.by_cycle else map(standing_for, self.quantity)
        return tuple(dict.fromkeys(names))

    def column(self, name: str) -> str:
        """Name of the column that a condition or an order means."""
        return name if name in self.asked else standing_for(name)


def needed_quantities(query: Query) -> tuple[str, ...]:
    """Quantities whose numbers a question needs.

    Raises
    ------
    SettingsError
        If the vocabulary lacks a name.
    """
    for option, names in (("--quantity", query.quantity), ("--sort", query.sort)):
        for name in names:
            if name not in QUANTITIES:
                raise SettingsError(
                    f"{option} names no quantity: '{name}'",
                    needed="a name of the vocabulary",
                    hint="docs/glossary.md lists them; `reduction catalogue --list` says which "
                    "there are.",
                )
    others = (query.column(name) for name in (*(one.name for one in query.where), *query.sort))
    return (*query.asked, *(name for name in dict.fromkeys(others) if name not in query.asked))


def answer(catalogue: Catalogue, query: Query) -> Any:
    """Rows that fit a question.

    Parameters
    ----------
    catalogue : Catalogue
        With the numbers of `needed_quantities`.
    query : Query
        What is asked.

    Returns
    -------
    table : pyarrow.Table
        `CONDITIONS`, the places of the numbers, and the quantities, each followed by its
        ``_standard_uncertainty``; SI.

    Raises
    ------
    SettingsError
        If the vocabulary lacks a name, or a condition or an order is about numbers that stand in
        several places of a test and are not asked for.
    """
    others = [name for name in needed_quantities(query) if name not in query.asked]
    table = rows_with(catalogue, catalogue.tests[_fits(catalogue.tests, query)], query.asked)
    for name in others:
        if name not in table:
            table = with_quantity(table, catalogue, name)
    for condition in query.where:
        table = table[_holds(table, query.column(condition.name), condition)]
    if query.sort:  # stable: rows that are alike stay in the order of their tests
        names = [query.column(name) for name in query.sort]
        table = _sorted(table, names, descending=query.descending)
    table = table.drop(columns="row").iloc[: query.limit]
    columns = {
        str(name): pyarrow.array(table[name], column_type(str(name)), from_pandas=True)
        for name in table
    }
    return pyarrow.table(columns)


def quantities_there(catalogue: Catalogue) -> dict[str, int]:
    """Quantities of a catalogue with all its numbers, and how many numbers each has, by name."""
    known = catalogue.numbers.dropna(subset="value")
    return {str(name): int(n) for name, n in known["quantity"].value_counts().sort_index().items()}


def _fits(tests: pd.DataFrame, query: Query) -> NDArray[np.bool_]:
    """Rows of tests that fit names and words."""
    fits = np.ones(len(tests), np.bool_)
    for column, patterns in query.names.items():
        wanted = [pattern.casefold() for pattern in patterns]

        def is_called(text: str, wanted: list[str] = wanted) -> bool:
            return any(fnmatchcase(text.casefold(), pattern) for pattern in wanted)

        fits &= _texts_that(tests[column], is_called)
    for column, asked in query.words.items():
        starts = _WORD.findall(asked.casefold())

        def has_words(text: str, starts: list[str] = starts) -> bool:
            there = _WORD.findall(text.casefold())
            return all(any(one.startswith(start) for one in there) for start in starts)

        fits &= _texts_that(tests[column], has_words)
    if query.synthetic is not None:
        fits &= (tests["synthetic"] == "yes").to_numpy() == query.synthetic
    return fits


def _texts_that(column: pd.Series[Any], fits: Callable[[str], bool]) -> NDArray[np.bool_]:
    """Entries of a column whose text fits; each text is asked once."""
    return column.isin([text for text in column.dropna().unique() if fits(text)]).to_numpy()


def _holds(table: pd.DataFrame, name: str, condition: Condition) -> NDArray[np.bool_]:
    """Rows of which a condition holds; a number or text that is missing fits none."""
    column = table[name]
    holds: NDArray[np.bool_]
    if isinstance(condition.value, str):
        holds = (column.str.lower() == condition.value.lower()).to_numpy(np.bool_)
        holds = holds == (condition.operator == "=")
        return np.logical_and(holds, column.notna().to_numpy(np.bool_))
    values = column.to_numpy(np.float64)
    if condition.is_share:
        values = values / table["rated_break_strength"].to_numpy(np.float64)
    with np.errstate(invalid="ignore"):
        holds = _COMPARE[condition.operator](values, condition.value)
    holds &= np.isfinite(values)
    return holds


def _sorted(table: pd.DataFrame, names: list[str], *, descending: bool) -> pd.DataFrame:
    """Rows in an order; those without the number last."""
    for name in reversed(names):
        table = table.sort_values(name, ascending=not descending, kind="stable")
    return table
