"""The catalogue of the tests, conditions and numbers of all campaigns."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow
import pyarrow.compute
import pyarrow.csv
import pyarrow.parquet
from numpy.typing import NDArray

from reduction import __version__
from reduction.archive.atomic_write import atomic_file
from reduction.archive.product_files import archives_in
from reduction.quantities.names import QUANTITIES
from reduction.quantities.units import DIMENSIONS, parse_quantity, scale_of_unit
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.plain_text import safe_cell

TEXTS: Final = (
    "campaign", "test", "specimen", "test_kind", "medium", "control", "waveform",
    "specimen_kind", "specimen_material", "specimen_construction", "specimen_condition",
    "synthetic", "archive",
)  # fmt: skip
"""Text conditions of a test."""

NUMBERS: Final = (
    "n_cycles", "test_frequency", "test_mean_tension", "test_tension_amplitude",
    "test_mean_strain", "test_strain_amplitude", "least_strain", "greatest_strain", "diameter",
    "rated_break_strength",
)  # fmt: skip
"""Numeric conditions of a test, in SI."""

CONDITIONS: Final = (*TEXTS[:-2], *NUMBERS, *TEXTS[-2:])
"""Columns of a table of tests in order."""

NUMBER: Final = ("quantity", "value", "standard_uncertainty")
"""Columns of a number; empty in a row for a test."""


def _column_type(name: str) -> Any:
    """Arrow type of a column from its row in the vocabulary: text if it has no unit."""
    if name == "quantity":
        return pyarrow.string()
    row = QUANTITIES.get(name)
    return pyarrow.float64() if row is None or row.unit else pyarrow.string()


def _standing_for(name: str) -> str:
    """Name of the mean over a test, if a cycle quantity has one.

    Examples
    --------
    >>> [_standing_for(name) for name in ("frequency", "peak_tension", "mean_tension")]
    ['test_frequency', 'peak_tension', 'test_mean_tension']
    """
    return f"test_{name}" if f"test_{name}" in QUANTITIES else name


FILE_NAME = "catalogue.parquet"

MARK = b"reduction_catalogue"

_FORMAT = "2"

_AGAIN = "Run the campaign again, or use --rebuild."

_NO_TESTS = pyarrow.schema(
    [("row", pyarrow.int32()), ("is_whole", pyarrow.bool_())]
    + [(name, _column_type(name)) for name in CONDITIONS]
).empty_table()

_NO_VALUES = pyarrow.schema(
    [("row", pyarrow.int32())] + [(name, _column_type(name)) for name in NUMBER]
).empty_table()


@dataclass(frozen=True)
class Catalogue:
    """Tests and numbers of a folder.

    Parameters
    ----------
    tests : pandas.DataFrame
        A row for each specimen of each archive, after one for the whole archive; the index is
        consecutive.
    numbers : pandas.DataFrame
        ``row`` of ``tests``, ``quantity``, ``value``, ``standard_uncertainty`` (SI), and a column
        for each dimension of the numbers.
    unreadable : dict of str to str
        Reasons for campaigns and archives left out.
    """

    tests: pd.DataFrame
    numbers: pd.DataFrame
    unreadable: dict[str, str]


def _mark() -> bytes:
    """Version mark of a catalogue."""
    return f"{_FORMAT} {__version__}".encode()


def load_catalogue(folder: Path, quantities: Sequence[str] | None = None) -> Catalogue:
    """Read the catalogues of all campaigns of a folder.

    Deleted archives are not included.
    """
    tests, values, unreadable = [_NO_TESTS], [_NO_VALUES], {}
    n_rows = 0
    for campaign in campaigns_below(folder):
        shown = _shown_path(campaign.name)
        try:
            there = {_shown_path(path.name) for path in _archives_of(campaign)}
            if not there:
                continue
            about, found = _tables_of(campaign / FILE_NAME, quantities)
        except (OSError, pyarrow.ArrowException) as error:
            words = getattr(error, "strerror", None) or str(error).partition("\n")[0]
            unreadable[shown] = f"{shown}: {FILE_NAME} cannot be read; found {words}. {_AGAIN}"
            continue
        known = about["archive"]
        for name in sorted(there - set(known.to_pylist())):
            unreadable[f"{shown}/{name}"] = f"{shown}/{name} is not in {FILE_NAME}. {_AGAIN}"
        about = _counted_from(n_rows, about)
        path = pyarrow.compute.binary_join_element_wise(shown, known, "/")
        about = about.set_column(about.schema.get_field_index("archive"), "archive", path)
        tests.append(about.filter(pyarrow.compute.is_in(known, pyarrow.array(sorted(there)))))
        values.append(_counted_from(n_rows, found))
        n_rows += about.num_rows
    of_tests = pyarrow.concat_tables(tests, promote_options="default").to_pandas()
    numbers = pyarrow.concat_tables(values, promote_options="default").to_pandas()
    numbers = numbers[numbers["row"].isin(of_tests["row"])]
    return Catalogue(of_tests.set_index("row"), numbers, unreadable)


def _tables_of(path: Path, quantities: Sequence[str] | None) -> tuple[Any, Any]:
    """Rows of tests, and of numbers without the conditions of their tests."""
    # opened here: a path may not be valid text; one thread is fastest for many small files
    with path.open("rb") as opened, pyarrow.parquet.ParquetFile(opened) as file:
        names = file.schema_arrow.names
        if (file.schema_arrow.metadata or {}).get(MARK) != _mark():
            raise OSError("one of another version, or of another program")
        about = file.read_row_group(0, columns=_NO_TESTS.column_names, use_threads=False)
        numbers = file.read_row_groups(
            range(1, file.num_row_groups),
            columns=[name for name in names if name not in (*CONDITIONS, "is_whole")],
            use_threads=False,
        )
    if quantities is not None:
        wanted = pyarrow.array(list(quantities), pyarrow.string())
        numbers = numbers.filter(pyarrow.compute.is_in(numbers["quantity"], wanted))
    return about, numbers


def _counted_from(first: int, table: Any) -> Any:
    row = pyarrow.compute.add(table["row"], pyarrow.scalar(first, pyarrow.int32()))
    return table.set_column(table.schema.get_field_index("row"), "row", row)


def _shown_path(path: str) -> str:
    r"""A path as text for any file; bytes that are not text become ``\\xff``.

    Examples
    --------
    >>> _shown_path("campaign\udcff/T-1.nc")
    'campaign\\xff/T-1.nc'
    """
    return path.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def _archives_of(campaign: Path) -> list[Path]:
    """Archives of a campaign by name, except those that begin with a dot."""
    return [path for path in archives_in(campaign) if not path.name.startswith(".")]


def campaigns_below(folder: Path) -> list[Path]:
    """Folders of the campaigns in a folder of products.

    In order of name; names that begin with a dot are left out.
    """
    if not folder.is_dir():
        raise SettingsError(
            f"there is no folder {_shown_path(str(folder))}",
            needed="a folder of processed campaigns",
            hint="Run a campaign first, or name the folder of its archives.",
        )
    try:
        with os.scandir(folder) as entries:
            inside = sorted((Path(one.path) for one in entries), key=lambda path: path.name)
    except OSError as error:
        raise SettingsError(
            f"the folder {_shown_path(str(folder))} cannot be read",
            found=error.strerror or str(error),
            needed="a folder of processed campaigns",
        ) from error
    for path in inside:
        if path.suffix == ".nc" and path.is_file():
            raise SettingsError(
                f"{_shown_path(str(folder))} is the folder of one campaign",
                found=f"the archive {_shown_path(path.name)}",
                needed="the folder above it, which holds the campaigns",
                hint="To see one of them, use --campaign.",
            )
    return [path for path in inside if not path.name.startswith(".") and path.is_dir()]


_FORM = re.compile(r"\s*(\w+)\s*(<=|>=|==|!=|<|>|=)\s*(.*?)\s*", re.DOTALL)

_SHARE = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*%\s*(?:RBS|MBS|MBL)")

_VALUE = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*)?")

_DIMENSION_OF: Final = {unit: name for name, unit in reversed(DIMENSIONS.items())} | {"1": "strain"}

_EXAMPLE = 'such as "frequency >= 0.1 Hz" or "medium = wet"'


@dataclass(frozen=True)
class _Condition:
    """Condition on a row.

    Parameters
    ----------
    name : str
        Quantity, unchanged.
    operator : str
        ``<``, ``<=``, ``>``, ``>=``, ``=`` or ``!=``; for text only the last two.
    value : float or str
        Number in the unit of the vocabulary, or a text.
    is_share : bool
        Whether the value is a share of the rated break strength of the row.
    """

    name: str
    operator: str
    value: float | str
    is_share: bool = False


def condition_of(text: str) -> _Condition:
    """Parse a condition.

    Examples
    --------
    >>> condition_of("mean_tension > 100 kN")
    _Condition(name='mean_tension', operator='>', value=100000.0, is_share=False)
    """
    form = _FORM.fullmatch(text)
    if form is None or not form[3]:
        raise SettingsError("--where is not a condition", found=repr(text), needed=_EXAMPLE)
    name, operator, value = form[1], form[2].replace("==", "="), form[3]
    row = QUANTITIES.get(name)
    if row is None:
        raise SettingsError(
            f"--where names no quantity: '{name}'",
            found=repr(text),
            needed="a name of the vocabulary",
            hint="`reduction catalogue --list` lists them; tables/columns.csv of a campaign "
            "explains them.",
        )
    if not row.unit:
        if operator not in ("=", "!="):
            raise SettingsError(
                f"'{name}' is text, which can only be equal or different",
                found=repr(text),
                needed=f'"{name} = ..." or "{name} != ..."',
            )
        return _Condition(name, operator, value)
    share = _SHARE.fullmatch(value)
    if share is not None and row.unit == "N":
        return _Condition(name, operator, _number(share[1], text) / 100, is_share=True)
    return _Condition(name, operator, _value(value, row.unit, name))


def _number(digits: str, text: str) -> float:
    try:
        return float(digits)
    except ValueError as error:
        raise SettingsError("--where has no number", found=repr(text), needed=_EXAMPLE) from error


def _value(text: str, unit: str, name: str) -> float:
    """Value in the unit of a quantity."""
    dimension = _DIMENSION_OF.get(unit)
    if dimension is not None:
        return parse_quantity(text, dimension)
    form = _VALUE.fullmatch(text)
    if form is None or form[2] is None:
        raise SettingsError(
            f"the value of '{name}' is not a number with a unit",
            found=repr(text),
            needed=f'text such as "1.5 {unit}"',
        )
    si_unit, factor, offset = scale_of_unit(form[2])
    own_unit, own_factor, _ = scale_of_unit(unit)
    if si_unit != own_unit:
        raise SettingsError(
            f"'{form[2]}' is not a unit of {name}",
            found=repr(text),
            needed=f"a unit such as {unit}",
        )
    return (factor * float(form[1]) + offset) / own_factor


_OWN = ("row", *NUMBER)


def rows_with(catalogue: Catalogue, tests: pd.DataFrame, asked: Sequence[str]) -> pd.DataFrame:
    """Rows of tests with the requested numbers.

    `CONDITIONS`, a column for each dimension, each quantity with its standard uncertainty, and
    ``row`` of ``catalogue.tests``; tests in order, places as in their archives.
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
        # one row without a place for tests that have none
        known = pd.concat([one.dropna(subset=name)["row"] for name, one in of_tests.items()])
        others = pd.DataFrame({"row": sorted(set(known) - set(rows["row"]))}, dtype=np.int64)
        rows = pd.concat([rows, others], ignore_index=True) if len(rows) else others
    for name, part in of_tests.items():
        rows = _beside(rows, part, name)
    if asked:
        rows = rows.dropna(subset=list(asked), how="all")
    rows = rows.reindex(columns=["row", *places, *(n for name in asked for n in _columns_of(name))])
    rows = rows.sort_values("row", kind="stable", ignore_index=True)
    # a condition requested as a quantity is included once, with its uncertainty
    names = [name for name in CONDITIONS if name not in asked]
    about = tests.loc[rows["row"], names].reset_index(drop=True)
    return pd.concat([about, rows], axis=1)


def _with_quantity(table: pd.DataFrame, catalogue: Catalogue, name: str) -> pd.DataFrame:
    """The same rows with a quantity of their tests added."""
    part = _numbers_of(catalogue.numbers, name)
    places = _places(part, name)
    if places:
        raise SettingsError(
            f"'{name}' has several values in a test",
            found=f"one number for each {' and '.join(places)}",
            needed=f"--quantity {name}, so that each place is a row",
        )
    return _beside(table, part, name)


def _numbers_of(values: pd.DataFrame, name: str) -> pd.DataFrame:
    """Numbers of a quantity with their places, in columns named after it."""
    part = values[values["quantity"] == name]
    places = [one for one in part.columns if one not in _OWN and part[one].notna().any()]
    part = part[["row", *places, "value", "standard_uncertainty"]]
    return part.rename(columns=dict(zip(NUMBER[1:], _columns_of(name), strict=True)))


def _places(part: pd.DataFrame, name: str) -> list[str]:
    """Dimensions of the numbers."""
    return [one for one in part.columns if one not in ("row", *_columns_of(name))]


def _columns_of(name: str) -> tuple[str, str]:
    return name, f"{name}_standard_uncertainty"


def _is_number(name: str, asked: Sequence[str]) -> bool:
    return any(name in _columns_of(one) for one in asked)


def _is_listed(tests: pd.DataFrame) -> NDArray[np.bool_]:
    """A row for each specimen, and for each archive without specimens."""
    is_whole = tests["is_whole"].to_numpy(bool)
    # the row of the whole archive precedes those of its specimens
    listed: NDArray[np.bool_] = ~is_whole | np.append(is_whole[1:], True)[: is_whole.size]
    return listed


def _beside(rows: pd.DataFrame, part: pd.DataFrame, name: str) -> pd.DataFrame:
    """Join the numbers of tests to each of their rows."""
    of_row = part.set_index("row")
    return rows.assign(**{one: rows["row"].map(of_row[one]) for one in _columns_of(name)})


_WORD = re.compile(r"[\w.]+")

# a value converted from another unit may differ in the last bit
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
    """Query of the catalogue.

    Parameters
    ----------
    names : dict of str to tuple of str
        Patterns with ``*``, ``?`` and ``[...]`` by column (``campaign``, ``test``, ``test_kind``,
        ``specimen``); one of them must match, ignoring case.
    words : dict of str to str
        Words by column (``medium``, ``specimen_material``, ...), each of which must begin a word of
        the text.
    synthetic : bool, optional
        Only synthetic, or only measured data.
    where : tuple of _Condition
        All must hold; a missing number meets none.
    quantity : tuple of str
        Quantities to show; a row needs at least one of them.
    by_cycle : bool
        Show a cycle quantity for each cycle kept instead of its mean over the test.
    sort : tuple of str
        Columns to sort by.
    descending : bool
        Largest first.
    limit : int, optional
        Maximum number of rows.
    """

    names: dict[str, tuple[str, ...]] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)
    synthetic: bool | None = None
    where: tuple[_Condition, ...] = ()
    quantity: tuple[str, ...] = ()
    by_cycle: bool = False
    sort: tuple[str, ...] = ()
    descending: bool = False
    limit: int | None = None

    @property
    def asked(self) -> tuple[str, ...]:
        """Requested quantities by their names in the catalogue."""
        names = self.quantity if self.by_cycle else map(_standing_for, self.quantity)
        return tuple(dict.fromkeys(names))

    def column(self, name: str) -> str:
        """Column of a condition or sort key."""
        return name if name in self.asked else _standing_for(name)


def needed_quantities(query: Query) -> tuple[str, ...]:
    """Quantities needed to answer a query."""
    for option, names in (("--quantity", query.quantity), ("--sort", query.sort)):
        for name in names:
            if name not in QUANTITIES:
                raise SettingsError(
                    f"{option} names no quantity: '{name}'",
                    needed="a name of the vocabulary",
                    hint="`reduction catalogue --list` lists them; tables/columns.csv of a "
                    "campaign explains them.",
                )
    others = (query.column(name) for name in (*(one.name for one in query.where), *query.sort))
    return (*query.asked, *(name for name in dict.fromkeys(others) if name not in query.asked))


def answer(catalogue: Catalogue, query: Query) -> Any:
    """Rows that match a query."""
    others = [name for name in needed_quantities(query) if name not in query.asked]
    table = rows_with(catalogue, catalogue.tests[_fits(catalogue.tests, query)], query.asked)
    for name in others:
        if name not in table:
            table = _with_quantity(table, catalogue, name)
    for condition in query.where:
        table = table[_holds(table, query.column(condition.name), condition)]
    if query.sort:  # stable: equal rows keep the order of their tests
        names = [query.column(name) for name in query.sort]
        table = _sorted(table, names, descending=query.descending)
    table = table.drop(columns="row").iloc[: query.limit]
    columns = {
        str(name): pyarrow.array(table[name], _column_type(str(name)), from_pandas=True)
        for name in table
    }
    return pyarrow.table(columns)


def quantities_there(catalogue: Catalogue) -> dict[str, int]:
    """Number of values of each quantity in a full catalogue, by name."""
    known = catalogue.numbers.dropna(subset="value")
    return {str(name): int(n) for name, n in known["quantity"].value_counts().sort_index().items()}


def _fits(tests: pd.DataFrame, query: Query) -> NDArray[np.bool_]:
    """Rows of tests that match names and words."""
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
    """Entries of a column whose text matches; each text is tested once."""
    return column.isin([text for text in column.dropna().unique() if fits(text)]).to_numpy()


def _holds(table: pd.DataFrame, name: str, condition: _Condition) -> NDArray[np.bool_]:
    """Rows that meet a condition; a missing number or text does not."""
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
    """Sorted rows, those without the number last."""
    for name in reversed(names):
        table = table.sort_values(name, ascending=not descending, kind="stable")
    return table


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
    """Description of a column."""
    row = QUANTITIES.get(name)
    if row is not None:
        return row.long_name
    base = QUANTITIES.get(name.removesuffix(_SPREAD))
    return name if base is None else f"standard uncertainty (k=1) of {base.long_name}"


def check_ending(path: Path) -> None:
    """Refuse a file that is neither CSV nor Parquet before the work is done."""
    if path.suffix.lower() not in (".csv", ".parquet"):
        raise SettingsError(
            "--export does not know this file ending",
            found=repr(path.name),
            needed="FILE.csv or FILE.parquet",
        )


def write_answer(table: Any, path: Path) -> None:
    """Write a table from `reduction.batch.catalogue.answer` in SI, completely or not at all."""
    check_ending(path)
    with _whole_file(path) as part:
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
                one.with_metadata({"units": unit_of(one.name), "long_name": meaning_of(one.name)})
                for one in table.schema
            ]
            pyarrow.parquet.write_table(table.cast(pyarrow.schema(fields)), part)


@contextmanager
def _whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary name for a file; `ArchiveError` if the disk refuses."""
    try:
        with atomic_file(path) as part:
            yield part
    except ArchiveError:
        raise
    except OSError as error:
        raise ArchiveError(
            f"{path} cannot be written",
            found=getattr(error, "strerror", None) or str(error),
            hint="What was there before is kept.",
        ) from error


def _safe(table: Any) -> Any:
    """The table without text that a spreadsheet program would take for a formula."""
    for place, column in enumerate(table.schema):
        if pyarrow.types.is_string(column.type) or pyarrow.types.is_large_string(column.type):
            texts = [None if one is None else safe_cell(one) for one in table[place].to_pylist()]
            table = table.set_column(place, column, pyarrow.array(texts, column.type))
    return table
