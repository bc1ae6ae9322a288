"""A table as the template prints it: header cells with units, numbers with their uncertainty.

What a reader sees is rounded to what is known; the value of the archive, SI and unrounded,
is beside it in ``data-value`` for a program that reads the page.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, isfinite, log10

from reduction.digits import fixed_number, places_of
from reduction.report.style import Shown

NOT_GIVEN = "\N{EN DASH}"
_LEAST_LEADING = 2.0
_LEAST_PROBABILITY = 1e-4
_MISSING = 1e-3
_NOISE = 1e-12
"""A sum of numbers of order one that ought to vanish ends at 1e-16 or so, in percent at 1e-14."""


@dataclass(frozen=True)
class Cell:
    """One cell: text as shown, the archive's own value, and whether it is a number.

    ``factors`` are the coverage factors of the uncertainties that the text shows.
    """

    text: str
    value: str = ""
    is_number: bool = False
    factors: tuple[float, ...] = ()


@dataclass(frozen=True)
class Table:
    """A table; the first cell of a row heads it.

    ``caption`` and ``remarks``, which stand below, are plain text.
    """

    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    is_tall: bool = False
    remarks: tuple[str, ...] = ()
    is_compact: bool = False

    @property
    def number_columns(self) -> tuple[bool, ...]:
        """Which columns hold numbers: they stand flush right, header and all."""
        return tuple(
            any(row[place].is_number for row in self.rows) for place in range(len(self.columns))
        )


def make_table(
    caption: str,
    columns: Sequence[str],
    rows: Sequence[Sequence[Cell]],
    *,
    synthetic: bool,
    is_tall: bool = False,
    remarks: Sequence[str] = (),
    is_compact: bool = False,
) -> Table:
    """Return a table; the caption says where the data are synthetic.

    A mark for what is missing stands flush right among numbers, whoever made its cell.
    """
    text = f"{caption} SYNTHETIC DATA." if synthetic else caption
    cells = tuple(tuple(row) for row in rows)
    plain = Table(text, tuple(columns), cells, is_tall, tuple(remarks), is_compact)
    missing = Cell(NOT_GIVEN, is_number=True)
    aligned = tuple(
        tuple(
            missing if is_number and cell.text == NOT_GIVEN else cell
            for cell, is_number in zip(row, plain.number_columns, strict=True)
        )
        for row in plain.rows
    )
    return replace(plain, rows=aligned)


def words(text: str) -> Cell:
    """Return a cell of text."""
    return Cell(text or NOT_GIVEN)


def number(value: float, unit: Shown | None = None, *, digits: int = 4) -> Cell:
    """Return a cell of one number, of so many digits."""
    scale = 1.0 if unit is None else unit.factor
    return Cell(number_text(value * scale, digits), _exact(value), is_number=True)


def count(value: float) -> Cell:
    """Return a cell of a number that is counted."""
    text = f"{value:,.0f}" if isfinite(value) else NOT_GIVEN
    return Cell(text, f"{value:.0f}" if isfinite(value) else "", is_number=True)


def number_text(value: float, digits: int = 4) -> str:
    """Return a number of so many digits, without a power of ten where it can be read so.

    Examples
    --------
    >>> number_text(1234567.0), number_text(0.012345)
    ('1,234,567', '0.01235')
    """
    if not isfinite(value):
        return NOT_GIVEN
    if abs(value) < _NOISE:
        return "0"
    if not 1e-4 <= abs(value) < 1e9:
        return f"{value:.{digits - 1}e}"
    return f"{value:,.{max(places_of(value, digits), 0)}f}"


def measured(
    value: float,
    uncertainty: float,
    unit: Shown | None = None,
    *,
    factor: float = float("nan"),
    is_short: bool = False,
) -> Cell:
    """Return a cell of a value and its expanded uncertainty, to two digits of the latter.

    That holds before the decimal point as well: digits that nothing is known of are zeros.
    ``factor`` is its coverage factor, for the words that explain the table.  The short form has
    one digit where that is 2 or more, and is off by a fifth at most.

    Examples
    --------
    >>> measured(1.23456e6, 1.2e4, Shown("MPa", 1e-6)).text
    '1.235 ± 0.012'
    >>> measured(156633.2, 1038.1).text
    '156,600 ± 1,000'
    >>> measured(1.23456e6, 7.2e3, Shown("MPa", 1e-6), is_short=True).text
    '1.235 ± 0.007'
    """
    scale = 1.0 if unit is None else unit.factor
    if not isfinite(value):
        return Cell(NOT_GIVEN, "", is_number=True)
    if not isfinite(uncertainty) or uncertainty <= 0:
        return number(value, unit)
    half = uncertainty * scale
    factors = (factor,) if isfinite(factor) else ()
    if max(abs(value * scale), half) < _NOISE:
        return number(value, unit)
    if not 1e-10 <= half < 1e9:
        text = f"{value * scale:.4g} ± {half:.2g}"
        return Cell(text, _exact(value), is_number=True, factors=factors)
    leading = half / 10.0 ** floor(log10(half))
    places = places_of(half, 1 if is_short and leading >= _LEAST_LEADING else 2)
    shown = f"{fixed_number(value * scale, places)} ± {fixed_number(half, places)}"
    return Cell(shown, _exact(value), is_number=True, factors=factors)


def within(value: float, low: float, high: float, unit: Shown) -> Cell:
    """Return a cell of a value and the ends of its interval, which need not lie evenly about it.

    Examples
    --------
    >>> within(4.8101, 3.8163, 6.4818, Shown("s", 1.0)).text
    '4.8 (3.8 to 6.5)'
    """
    shown, ends = with_interval(value, low, high, unit)
    return Cell(f"{shown.text} ({ends.text})", shown.value, is_number=True)


def with_interval(value: float, low: float, high: float, unit: Shown) -> tuple[Cell, Cell]:
    """Return a cell of a value and one of its interval, to two digits of half of that.

    Examples
    --------
    >>> [cell.text for cell in with_interval(156633.2, 155595.0, 157671.0, Shown("N", 1.0))]
    ['156,600', '155,600 to 157,700']
    """
    if not (isfinite(low) and isfinite(high)):
        return number(value, unit), Cell(NOT_GIVEN, is_number=True)
    places = places_of((high - low) / 2 * unit.factor, 2)
    shown, *ends = (fixed_number(one * unit.factor, places) for one in (value, low, high))
    interval = Cell(" to ".join(ends), f"{_exact(low)} {_exact(high)}", is_number=True)
    return Cell(shown, _exact(value), is_number=True), interval


def factors_of(rows: Iterable[Iterable[Cell]]) -> list[float]:
    """Return the coverage factors of all uncertainties of a table.

    Examples
    --------
    >>> factors_of([[words("new"), measured(2.0, 0.4, factor=1.96)]])
    [1.96]
    """
    return [factor for row in rows for cell in row for factor in cell.factors]


def probability(value: float) -> Cell:
    """Return a cell of a probability; below 0.0001 only that it is.

    Examples
    --------
    >>> probability(0.0312).text, probability(2e-9).text
    ('0.0312', '<0.0001')
    """
    if not isfinite(value):
        return Cell(NOT_GIVEN, is_number=True)
    text = "<0.0001" if value < _LEAST_PROBABILITY else f"{value:.4f}"
    return Cell(text, _exact(value), is_number=True)


def share_text(value: float) -> str:
    """Return a share of a whole with the first digits by which it misses the whole.

    Examples
    --------
    >>> share_text(0.9735), share_text(0.9999808)
    ('0.974', '0.99998')
    """
    if not isfinite(value):
        return NOT_GIVEN
    missing = abs(1 - value)
    digits = 3 if missing > _MISSING else min(8, ceil(-log10(max(missing, 1e-8))))
    return f"{value:.{digits}f}"


def span(low: float, high: float, unit: Shown, *, places: int) -> Cell:
    """Return a cell of a range, both ends to so many decimal places or more: two digits of it.

    Examples
    --------
    >>> span(0.0021, 0.0043, Shown("%", 100.0), places=0).text
    '0.21 to 0.43'
    """
    if not (isfinite(low) and isfinite(high)):
        return Cell(NOT_GIVEN, "", is_number=True)
    ends = (low * unit.factor, high * unit.factor)
    places = max(places, places_of(ends[1] - ends[0], 2))
    text = " to ".join(fixed_number(end, places) for end in ends)
    return Cell(text, f"{_exact(low)} {_exact(high)}", is_number=True)


def interval(low: float, high: float, unit: Shown | None = None, *, digits: int = 3) -> Cell:
    """Return a cell of a range, each end to so many digits; nothing where neither is known.

    Examples
    --------
    >>> interval(0.1, 12.5).text
    '0.100 to 12.5'
    """
    if not (isfinite(low) or isfinite(high)):
        return words("")
    scale = 1.0 if unit is None else unit.factor
    text = " to ".join(number_text(end * scale, digits) for end in (low, high))
    return Cell(text, f"{low!r} {high!r}", is_number=True)


def _exact(value: float) -> str:
    return repr(float(value)) if isfinite(value) else ""
