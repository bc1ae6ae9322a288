"""Declared columns of a log: found once, with their units and numbers checked."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from tokenize import TokenError
from typing import Any, Protocol, get_args

import numpy as np
from numpy.typing import NDArray

from reduction.quantities.units import Dimension, scale_to_si
from reduction.readers.layout import CLOCK, DateOrder, Layout, LogParts, Watch
from reduction.readers.text_rows import split_line
from reduction.record.errors import LogError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.plain_text import cut
from reduction.record.samples import ColumnWriter, check_room

CLOCK_TEXT = re.compile(
    r"(?:(?:(\d{4})[-/](\d{1,2})[-/](\d{1,2})|(\d{1,2})\.(\d{1,2})\.(\d{4}))[T ]\s*)?"
    r"(\d{1,2}):?([0-5]\d)(?::([0-5]\d(?:[.,]\d+)?))?(?:\s*([AaPp])\.?[Mm]\.?)?"
    r"(Z|(?:\s*[+-][01]\d:?[0-5]\d))?"
)
"""A time of day, with or without a date before it; `plain_date` converts other dates to this."""

_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")

_NAMED_DATE = re.compile(
    rf"(\d{{1,2}})[- ]({'|'.join(_MONTHS)})[a-z]*[- ](\d{{4}})(?=[T ])", re.IGNORECASE
)

_DATE_OF_EITHER_ORDER = re.compile(r"(\d{1,2})([-/])(\d{1,2})\2(\d{4}|\d\d)(?=[T ])")

_CENTURY = 69  # two-digit years from here on belong to the last century, as in POSIX


def plain_date(text: str, order: DateOrder | None) -> str:
    """A clock time with its date, if any, in the form of `CLOCK_TEXT` where possible.

    Examples
    --------
    >>> plain_date("05/31/2005 09:45", "month first"), plain_date("31-May-2005 09:45", None)
    ('31.05.2005 09:45', '31.5.2005 09:45')
    >>> plain_date("05/06/05 09:45", "day first"), plain_date("05/06/05 09:45", None)
    ('05.06.2005 09:45', '05/06/05 09:45')
    """
    if found := _NAMED_DATE.match(text):
        day, month, year = found[1], f"{_MONTHS.index(found[2].lower()) + 1}", found[3]
    elif order is not None and (found := _DATE_OF_EITHER_ORDER.match(text)):
        day, _, month, year = found.groups()
        if order == "month first":
            day, month = month, day
        if len(year) == 2:
            year = f"{19 if int(year) >= _CENTURY else 20}{year}"
    else:
        return text
    return f"{day}.{month}.{year}{text[found.end() :]}"


def orders_of_dates(texts: Sequence[str]) -> tuple[DateOrder, ...] | None:
    """Date orders in which all dates are valid; None if no clock time has a date in either order.

    Examples
    --------
    >>> orders_of_dates(["05/12/2005 23:59", "05/13/2005 00:01"])
    ('month first',)
    """
    dates = [either for text in texts if (either := _DATE_OF_EITHER_ORDER.match(text))]
    if not dates:
        return None
    return tuple(
        order for order in get_args(DateOrder)
        if all(clock_reading(plain_date(either.string, order)) is not None for either in dates)
    )  # fmt: skip


DAY = 86400.0


def clock_to_seconds(
    path: Path,
    texts: Sequence[str],
    *,
    channel: str,
    missing: Sequence[str],
    row: Integers | None,
    first_row: int,
) -> Floats:
    """Seconds from the first reading, shape (n_rows,); missing marks are NaN. [s]."""
    seconds, days = np.full((2, len(texts)), np.nan)
    for index, text in enumerate(texts):
        if text in missing:
            continue
        reading = clock_reading(text)
        if reading is None:
            raise LogError(
                path,
                "a reading is not a clock time",
                row=first_row + index if row is None else int(row[index]),
                channel=channel,
                found=f"'{text}'",
                needed="hours and minutes, such as 0945, 09:45, 09:45:30 or 9:45:30 PM, or a date "
                "before them, 2024-05-31 09:45:30 or 31.05.2024 09:45:30",
                hint=_order_to_set(texts),
            )
        days[index], seconds[index] = reading
    valid = np.flatnonzero(np.isfinite(seconds))
    if not valid.size:
        return seconds
    read, dates = seconds[valid], days[valid]
    if np.isfinite(dates).all():
        day = dates - dates[0]
        for before in np.flatnonzero((np.diff(day) > 27) & (np.diff(read) < -DAY / 2)):
            last, then = (date.fromordinal(int(one)) for one in dates[before : before + 2])
            if last.day == then.day and (then - last).days < 32:
                index = int(valid[before + 1])
                raise LogError(
                    path,
                    "the date goes on by a month at midnight: day and month are read in the wrong"
                    " order",
                    row=first_row + index if row is None else int(row[index]),
                    channel=channel,
                    found=f"{then} after {last}",
                    needed="the next day",
                    hint="Set date_order of the time to the other order, or write the dates as "
                    "2024-05-31.",
                )
    elif np.isnan(dates).all():
        day = np.cumsum(np.diff(read, prepend=read[0]) < -DAY / 2).astype(np.float64)
    else:
        raise LogError(
            path, "some readings of a clock have a date and some have none",
            channel=channel, needed="a date in every row, or in none",
        )  # fmt: skip
    seconds[valid] = read + DAY * day - read[0]
    return seconds


def _order_to_set(texts: Sequence[str]) -> str | None:
    """Date order that the layout should state for a clock."""
    orders = orders_of_dates(texts)
    if orders is None:
        return None
    if len(orders) == 1:
        return f'Set date_order = "{orders[0]}" for the time: no other order gives valid dates.'
    return (
        'Set date_order = "month first" or "day first" for the time: in a date with slashes or '
        "dashes, the first number may be either."
        if orders
        else "Neither number of these dates is a month in every row."
    )


def clock_reading(text: str) -> tuple[float, float] | None:
    """Day number (NaN without a date) and seconds from midnight; None if not a clock time."""
    match = CLOCK_TEXT.fullmatch(text)
    day = math.nan if match is None else _day_of(match)
    is_no_day = match is not None and bool(match[1] or match[4]) and math.isnan(day)
    if match is None or is_no_day:
        return None
    hour, half = int(match[7]), (match[10] or "").lower()
    if hour > 23 or (half and not 1 <= hour <= 12):
        return None
    if half:
        hour = hour % 12 + 12 * (half == "p")
    in_minute = float((match[9] or "0").replace(",", "."))
    return day, 3600 * hour + 60 * int(match[8]) + in_minute - _of_zone(match[11])


def is_of_a_zone(text: str) -> bool:
    """Whether a clock time states its UTC offset, so that it is not set for daylight saving."""
    match = CLOCK_TEXT.fullmatch(text)
    return match is not None and bool(match[11])


def _of_zone(text: str | None) -> float:
    """Seconds by which the zone of a clock is ahead of UTC."""
    digits = (text or "").strip(" Z").replace(":", "")
    if not digits:
        return 0.0
    ahead = 3600.0 * int(digits[1:3]) + 60 * int(digits[3:])
    return -ahead if digits[0] == "-" else ahead


def _day_of(match: re.Match[str]) -> float:
    """Day number from the date before a clock time; NaN without a date."""
    year, month, day = (
        (match[1], match[2], match[3]) if match[1] else (match[6], match[5], match[4])
    )
    try:
        return float(date(int(year), int(month), int(day)).toordinal())
    except (TypeError, ValueError):  # no date, or an impossible one such as 31 February
        return math.nan


FORCE_OF_MASS = {"kg": "kgf", **dict.fromkeys(("t", "to", "te", "tonne", "tonnes"), "tf")}
"""Force units that scales write as masses."""

_BRACKETS = {"(": ")", "[": "]", "{": "}", "<": ">"}

_SHOWN = 40

_LONGEST_SHOWN = 200

_LONGEST_UNIT = 30

_POWER = re.compile(r"\*\*|\^")  # at most one: 9**9**9 would take forever


@dataclass(frozen=True)
class DeclaredColumn:
    """One column requested by a layout; ``key`` is its name in `RawLog.columns`."""

    key: str
    column: str | int
    unit: str
    dimension: Dimension
    is_compared: bool = True
    """Whether a unit stated by the file must agree: not for a clock or a voltage."""
    has_factor: bool = False
    """Whether a factor is stated, even 1: the file may then be in another quantity."""


def declared_columns(layout: Layout) -> tuple[DeclaredColumn, ...]:
    """Columns of a layout in its order; a channel's own time stamps follow it."""
    wanted = []
    for key, channel in layout.channels.items():
        is_compared = channel.unit != CLOCK and channel.factor == 1
        dimension = Layout.dimension(key)
        has_factor = "factor" in channel.model_fields_set
        wanted.append(
            DeclaredColumn(key, channel.column, channel.unit, dimension, is_compared, has_factor)
        )
        if channel.time_column is not None:
            wanted.append(
                DeclaredColumn(f"{key}.time", channel.time_column, channel.time_unit, "time")
            )
    return tuple(wanted)


def _listing(names: Sequence[str]) -> str:
    if not names:
        return "no columns"
    if not any(names):
        return f"columns without names, numbers 1 to {len(names)}"
    shown = ", ".join(repr(name[:_LONGEST_SHOWN]) for name in names[:_SHOWN])
    return shown if len(names) <= _SHOWN else f"{shown} and {len(names) - _SHOWN} more"


def find_column(
    path: Path,
    wanted: DeclaredColumn,
    names: Sequence[str],
    *,
    where: str = "the file",
    in_order: bool = True,
    row: int | None = None,
) -> int:
    """Index (from 0) of a declared column among the names of a file."""
    stripped = [name.strip() for name in names]
    if isinstance(wanted.column, int):
        if in_order and 1 <= wanted.column <= len(names):
            return wanted.column - 1
        needed = f"a number from 1 to {len(names)}" if in_order else "a name"
        raise LogError(
            path,
            f"column {wanted.column} is not in {where}",
            row=row,
            channel=wanted.key,
            found=_listing(stripped),
            needed=needed,
        )
    places = [place for place, name in enumerate(stripped) if name == wanted.column.strip()]
    if len(places) == 1:
        return places[0]
    if places:
        raise LogError(
            path,
            f"column '{wanted.column}' appears {len(places)} times in {where}",
            row=row,
            channel=wanted.key,
            found="numbers " + ", ".join(str(place + 1) for place in places),
            needed="one column of that name",
            hint="Give the column by its number." if in_order else None,
        )
    raise LogError(
        path,
        f"column '{wanted.column}' is not in {where}",
        row=row,
        channel=wanted.key,
        found=_listing(stripped),
        needed=f"'{wanted.column}'",
        hint=_why_not_there(wanted.column.strip(), stripped, is_text=row is not None),
    )


def _why_not_there(wanted: str, names: Sequence[str], *, is_text: bool) -> str | None:
    """Likely reason why a name is not found: another delimiter or spelling, or lines above."""
    for mark in ";,\t|":
        if any(wanted in map(str.strip, name.split(mark)) for name in names if mark in name):
            shown = {"\t": "\\t"}.get(mark, mark)
            return f'The names are separated by "{shown}": set delimiter = "{shown}".'
    alike = [name for name in names if name.casefold() == wanted.casefold()]
    if alike:
        return f"It is spelled '{alike[0]}' there."
    if is_text:
        return (
            "Lines above the names (a preamble of the logger) are skipped with preamble_rows = N,"
            " or with comment if they begin with a mark."
        )
    return None


def stated_scale(text: str, dimension: Dimension) -> tuple[float, float]:
    """Factor and offset to SI of a unit stated by a file, which may be any text."""
    try:
        if len(text) <= _LONGEST_UNIT and len(_POWER.findall(text)) < 2:
            return scale_to_si(text, dimension)
    except (AssertionError, TokenError, ArithmeticError):  # pint's answers to "kN/" and "m/0"
        pass
    raise SettingsError(
        f"unit '{text[:_LONGEST_UNIT]}' is not known", needed=f"a unit of {dimension}"
    )


def check_unit(path: Path, wanted: DeclaredColumn, found: str, *, row: int | None = None) -> None:
    """Compare the unit stated by the file with the declared one; a blank states nothing."""
    text = found.strip()
    if text[:1] in _BRACKETS and text.endswith(_BRACKETS[text[0]]):
        text = text[1:-1].strip()
    if wanted.dimension == "force":
        text = FORCE_OF_MASS.get(text, text)
    if text in ("", "-", wanted.unit.strip()) or not wanted.is_compared:
        return
    try:
        stated = stated_scale(text, wanted.dimension)
    except SettingsError as error:
        if wanted.has_factor:
            return
        problem = error.problem
    else:
        declared = scale_to_si(wanted.unit, wanted.dimension)
        if all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(stated, declared, strict=True)):
            return
        problem = "the unit in the file is not the declared one"
    raise LogError(
        path,
        problem,
        row=row,
        channel=str(wanted.column),
        found=f"'{found.strip()}'",
        needed=f"'{wanted.unit}', as the layout declares",
        hint=f"Declare the unit of the file. For a column of another quantity, such as stress or % "
        f"of break strength, state factor: the value of 1 of it in {wanted.unit}.",
    )


def check_lengths(path: Path, columns: dict[str, Floats]) -> int:
    """Number of rows shared by the columns; a channel with own time stamps has its own."""
    pairs = [(key, f"{key}.time") for key in columns if f"{key}.time" in columns]
    shared = [key for key in columns if not any(key in pair for pair in pairs)]
    for group in (shared, *pairs):
        if len({columns[key].size for key in group}) > 1:
            raise LogError(
                path,
                "the columns have two time bases",
                found=", ".join(f"{key} {columns[key].size} values" for key in group),
                needed="columns of one length",
                hint="Give a channel with its own time stamps a time_column.",
            )
    if not columns:
        raise LogError(path, "the layout declares no channels", needed="at least one channel")
    n_rows = columns[shared[0]].size if shared else max(columns[key].size for key in columns)
    if n_rows == 0:
        raise LogError(path, "there are no data rows", found="0 rows", needed="at least one")
    return n_rows


def without_marks(values: NDArray[Any], layout: Layout) -> Floats:
    """Values as float64, with NaN for numeric missing marks (-9999); the shape is kept."""
    marks = []
    for mark in layout.missing:
        try:
            value = float(mark.replace(layout.decimal, "."))
        except ValueError:
            continue
        if math.isfinite(value):
            marks.append(value)
    array = values.astype(np.float64, copy=bool(marks))
    for value in marks:
        array[values == value] = np.nan
    return array


_LONGEST_NAME = 200  # characters at the end of a name searched for a unit

_UNIT_IN_NAME = re.compile(r".*[\(\[]\s*([^()\[\]]*[^()\[\]\d\s][^()\[\]]*)[\)\]]\s*$")


_UNIT_WORDS = {
    "force": ("kN", "KN", "MN", "daN", "N", "lbf", "lbs", "lb", "klbf", "kips", "kip", "kgf", "kg"),
    "length": ("mm", "cm", "inches", "inch", "in", "ft", "m"),
    "time": ("ms", "sec", "min", "s"),
    "voltage": ("mV", "V"),
    "strain": ("mm/mm", "mm/m", "in/in", "m/m", "%", "pct"),
}
"""Units that may end a column name without brackets, by dimension."""

# load_kN, Kraft/kN, "Load, kN", "F in kN", "Load kN"
UNIT_BEHIND_NAME = re.compile(
    r"(?:.*?[^\W\d_]\d*)(?:_|/|,\s*|\s+in\s+|\s+)("
    + "|".join(unit for units in _UNIT_WORDS.values() for unit in units)
    + r")\s*$"
)
"""A name that ends in its unit without brackets; the unit is the first group."""


def keep_line(metadata: dict[str, str], line: str, row: int, layout: Layout) -> None:
    """Keep a line as metadata: ``name: value`` or two fields by name, others by row."""
    text = line.removeprefix(layout.comment).strip() if layout.comment else line.strip()
    fields = [field for field in split_line(text, layout) if field]
    if not fields:
        return
    key, value = fields[0].rstrip(": "), " ".join(fields[1:])
    if not value and ": " in text:
        key, value = (part.strip() for part in text.split(": ", 1))
    if not key or not value or line.startswith(layout.comment or "\n"):
        key, value = f"row {row}", text
    if key in metadata:
        key = f"{key} (row {row})"
    metadata[cut(key)] = cut(value)


def check_units(
    path: Path,
    wanted: Sequence[tuple[DeclaredColumn, int]],
    *,
    names: Sequence[str],
    units: Sequence[str],
    unit_row: int | None,
) -> None:
    """Compare the units stated by the file with the declared ones."""
    for want, place in wanted:
        if not want.is_compared or want.dimension == "number":
            continue
        if unit_row is not None:
            check_unit(path, want, units[place] if place < len(units) else "", row=unit_row)
        elif isinstance(want.column, str):
            name = names[place][-_LONGEST_NAME:]
            if match := _UNIT_IN_NAME.match(name):
                _check_unit_in_name(path, want, match[1])
            elif match := UNIT_BEHIND_NAME.match(name):
                _check_unit_in_name(path, want, match[1])
                _check_dimension_in_name(path, want, match[1])


def _check_dimension_in_name(path: Path, want: DeclaredColumn, stated: str) -> None:
    """Refuse a column whose name ends in a unit of another dimension than declared."""
    known = {dimension for dimension, units in _UNIT_WORDS.items() if stated in units}
    if want.has_factor or want.dimension not in _UNIT_WORDS or want.dimension in known:
        return
    (of,) = known
    raise LogError(
        path,
        f"the name of the column states a unit of {of}, and the layout declares a {want.dimension}",
        channel=str(want.column),
        found=f"'{stated}'",
        needed=f"'{want.unit}' or another unit of {want.dimension}",
        hint=(
            "Set unit and factor of the channel to the value of one volt of the amplifier."
            if of == "voltage"
            else "Are two columns swapped in the layout? Otherwise give the column by its number."
        ),
    )


def _check_unit_in_name(path: Path, want: DeclaredColumn, stated: str) -> None:
    try:
        text = (FORCE_OF_MASS | {"pct": "%"}).get(stated.strip(), stated.strip())
        found = scale_to_si(text, want.dimension)
    except SettingsError:
        return
    declared = scale_to_si(want.unit, want.dimension)
    if not all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(found, declared, strict=True)):
        raise LogError(
            path,
            "the unit in the column's name is not the declared one",
            channel=str(want.column),
            found=f"'{stated}'",
            needed=f"'{want.unit}', as the layout declares",
            hint="Declare the unit of the file, or give the column by its number.",
        )


_EXACT = 2**53  # integers beyond this are not exact in float64

_KINDS = {
    "b": "true or false",
    "c": "complex numbers",
    "M": "dates",
    "m": "durations",
    "S": "text",
    "U": "text",
    "T": "text",
    "O": "text or objects",
    "V": "records",
}

_LARGE = (
    "whole numbers too large to be held exactly", "numbers below 2**53",
    "Write time as elapsed time.",
)  # fmt: skip

_MISSING = (
    "NaN", "a number", 'Add "NaN" to the missing marks of the layout where it means missing.',
)  # fmt: skip

_INFINITE = ("infinite", "finite numbers", None)

_FAULTS = (_LARGE, _MISSING, _INFINITE)  # faults in the order in which they are reported


class _CheckedColumn:
    """A declared column, shape (n_rows,), with NaN for declared missing marks."""

    def __init__(
        self, path: Path, wanted: DeclaredColumn, layout: Layout, folder: Path | None
    ) -> None:
        """Start with no rows."""
        self._path, self._wanted, self._layout = path, wanted, layout
        self._writer = ColumnWriter(folder)
        self._nan_is_missing = any(mark.lower() == "nan" for mark in layout.missing)
        self._found: dict[tuple[str, str, str | None], tuple[int, int, float]] = {}

    def add(self, values: NDArray[Any]) -> None:
        """Add rows, shape (n_rows,)."""
        kind = values.dtype.kind
        if self._wanted.unit == CLOCK or kind not in "fiu":
            raise LogError(
                self._path,
                "a column does not hold numbers",
                channel=str(self._wanted.column),
                found=f"{_KINDS.get(kind, 'something else')} ({values.dtype})",
                needed="elapsed time: a clock is read from text alone"
                if self._wanted.unit == CLOCK
                else f"real numbers in {self._wanted.unit}",
            )
        # damage gives signalling NaNs; a wider float may overflow here, which is reported
        with np.errstate(invalid="ignore", over="ignore"):
            array = values.astype(np.float64, copy=False)
            column = without_marks(values, self._layout)
        if kind in "iu":
            self._look(_LARGE, array, np.abs(array) > _EXACT)
        elif not np.all(np.isfinite(array)):
            if not self._nan_is_missing:
                self._look(_MISSING, array, np.isnan(array))
            self._look(_INFINITE, array, np.isinf(array))
            column = np.where(np.isnan(column), np.nan, column)
        self._writer.append(column)

    def finish(self) -> Floats:
        """The column."""
        for fault in _FAULTS:
            if fault in self._found:
                count, first, value = self._found[fault]
                what, needed, hint = fault
                raise LogError(
                    self._path,
                    f"{count} of {self._writer.size} values are {what}, first value {first + 1}",
                    channel=str(self._wanted.column),
                    found=f"{value:.17g}",
                    needed=needed,
                    hint=hint,
                )
        return self._writer.finish()

    def _look(self, fault: tuple[str, str, str | None], values: Floats, bad: Bools) -> None:
        """Count the values with a fault, and keep the first of them."""
        places = np.flatnonzero(bad)
        if places.size:
            first = (0, self._writer.size + int(places[0]), float(values[places[0]]))
            count, place, value = self._found.get(fault, first)
            self._found[fault] = (count + places.size, place, value)


_PART = 16 << 20  # bytes of a matrix read at a time


@dataclass(frozen=True)
class ColumnTable:
    """The columns of a binary file before any is read.

    Parameters
    ----------
    names, units : tuple of str
        From the file; empty text where it states none.
    load : callable
        Values of one column by its index from 0, in parts of the given number of rows if the file
        can be read so; at least one part.
    n_rows : int
        Rows of the longest column read in parts; 0 if the columns are read whole.
    where : str
        Location of the columns, for messages: ``group 'log'``.
    in_order : bool
        Whether a column may be named by its number.
    sizes : tuple of int
        Number of values in each column if the file states it, else empty.
    is_turned : bool
        Whether the columns are the rows of a matrix.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    load: Callable[[int, int], Iterator[NDArray[Any]]]
    n_rows: int = 0
    where: str = "the file"
    in_order: bool = True
    sizes: tuple[int, ...] = ()
    is_turned: bool = False


class _Matrix(Protocol):
    """An array, or a data set whose rows are read on request."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows and columns."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values, with fields if the columns have names."""

    @property
    def T(self) -> _Matrix:  # noqa: N802 (as in numpy)
        """Rows and columns exchanged."""

    def __getitem__(self, rows: slice, /) -> NDArray[Any]:
        """Selected rows."""


def is_wide(matrix: _Matrix) -> bool:
    """Whether a matrix has a row per channel: Simulink writes a column per reading.

    Examples
    --------
    >>> is_wide(np.zeros((3, 1000))), is_wide(np.zeros((1000, 3)))
    (True, False)
    """
    if matrix.dtype.names is not None or len(matrix.shape) != 2:
        return False
    return matrix.shape[1] > _WIDE * matrix.shape[0]


_WIDE = 3  # columns per row of a matrix that is no table of readings


def matrix_table(
    path: Path,
    matrix: _Matrix,
    *,
    where: str,
    names: tuple[str, ...] | None = None,
    units: tuple[str, ...] | None = None,
) -> ColumnTable:
    """Columns of a matrix, its rows if it has a row per channel, or a table's named fields."""
    is_turned = is_wide(matrix)
    if is_turned:
        matrix = matrix.T
    fields = matrix.dtype.names
    if fields is not None:
        if len(matrix.shape) != 1:
            matrix = matrix[:].ravel()
        n_columns = len(fields)
    elif len(matrix.shape) == 2:
        n_columns = matrix.shape[1]
    else:
        raise LogError(
            path, f"{where} is not a matrix", found=f"shape {matrix.shape}",
            needed="rows and columns",
        )  # fmt: skip
    for what, texts in (("names", names), ("units", units)):
        if texts is not None and len(texts) != n_columns:
            raise LogError(
                path, f"the number of columns of {where} is not its number of {what}",
                found=f"{n_columns} columns, {what} {', '.join(texts)}",
                needed=f"{n_columns} {what}",
            )  # fmt: skip
    total = matrix.shape[0]
    held: list[tuple[slice, NDArray[Any]]] = []  # rows already read for earlier columns

    row_size = max(matrix.dtype.itemsize * (1 if fields else n_columns), 1)

    def load(place: int, n_rows: int) -> Iterator[NDArray[Any]]:
        n_rows = max(min(n_rows, _PART // row_size), 1)  # all columns are read; few may be wanted
        for part in row_parts(total, n_rows, getattr(matrix, "n_together", 1)):
            if not held or held[0][0] != part:
                held[:] = [(part, matrix[part])]
            rows = held[0][1]
            yield rows[fields[place]] if fields else rows[:, place]

    return ColumnTable(
        names=names or fields or ("",) * n_columns,
        units=units or ("",) * n_columns,
        load=load,
        n_rows=total,
        where=where,
        sizes=(total,) * n_columns,
        is_turned=is_turned,
    )


def row_parts(total: int, n_rows: int, n_together: int = 1) -> Iterator[slice]:
    """Slices of `n_rows` rows, of whole chunks if the file has them; at least one.

    Examples
    --------
    >>> [(part.start, part.stop) for part in row_parts(10, 5, n_together=4)]
    [(0, 4), (4, 8), (8, 10)]
    """
    step = max(n_rows // n_together, 1) * n_together
    for start in range(0, max(total, 1), step):
        yield slice(start, min(start + step, total))


def read_columns(
    path: Path,
    layout: Layout,
    table: ColumnTable,
    made: Mapping[str, Callable[[int], Iterator[Floats]]] | None = None,
    *,
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> tuple[dict[str, Floats], int]:
    """Declared columns of a binary file by channel key, and their number of rows."""
    made, parts, watch = made or {}, parts or LogParts(), watch or Watch(path)
    watch.check_columns(len(table.names))
    wanted = declared_columns(layout)
    places = {}
    for want in wanted:
        if want.key not in made:
            places[want.key] = _place(path, want, table)
    n_bytes = 8 * table.n_rows * len(wanted)
    folder = parts.folder_of(n_bytes)
    if folder is not None:
        stated = (
            [table.sizes[place] for place in places.values()] if table.sizes else [table.n_rows]
        )
        check_room(folder, 8 * sum(stated))
    n_rows = max(parts.length_of(n_bytes) // (8 * max(len(wanted), 1)), 1)
    checked = {
        want.key: _CheckedColumn(path, want, layout, folder)
        for want in wanted
        if want.key in places
    }
    writers = {key: ColumnWriter(folder) for key in made}
    coming = [
        *((column.add, table.load(places[key], n_rows)) for key, column in checked.items()),
        *((writer.append, made[key](n_rows)) for key, writer in writers.items()),
    ]
    while coming:  # in step: columns of a matrix come from the same rows
        watch.check_time()
        going = []
        for add, values in coming:
            if (part := next(values, None)) is not None:
                add(part)
                going.append((add, values))
        coming = going
    columns = {
        want.key: (checked[want.key] if want.key in checked else writers[want.key]).finish()
        for want in wanted
    }
    return columns, check_lengths(path, columns)


def _place(path: Path, wanted: DeclaredColumn, table: ColumnTable) -> int:
    """Index of a declared column, after a check of its unit."""
    place = find_column(path, wanted, table.names, where=table.where, in_order=table.in_order)
    if table.units[place]:
        check_unit(path, wanted, table.units[place])
    else:  # a name such as "Force (kN)" may state it
        check_units(path, [(wanted, place)], names=table.names, units=(), unit_row=None)
    return place
