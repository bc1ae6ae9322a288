"""Style of the page: colours, units, HTML tables, names of sources.

Sources of one instrument or one object share a hue and differ in hatching, so that readers with any
colour vision, and of a grey print, can separate more sources than there are colours.

References
----------
.. [1] Okabe and Ito, Color Universal Design, University of Tokyo, 2008.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, floor, isfinite, log10
from typing import Any, Literal

import numpy as np

from reduction.quantities.digits import fixed_number, places_of
from reduction.quantities.units import UnitSystem, display_unit
from reduction.uncertainty.budget import RANDOM

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#686868")

DASHES = {"ascending": "solid", "descending": "dash"}

LINE_DASHES = ("solid", "dash", "dot", "dashdot")
"""One after the other, where lines differ by more than colour."""

SYMBOLS = ("circle", "square", "diamond", "triangle-up", "cross", "x", "star", "triangle-down")

FILLINGS = ("", "-open", "-dot", "-open-dot")

PHASE_FILLS = {
    "rest": "rgba(140,140,140,0.20)",
    "approach": "rgba(230,159,0,0.16)",
    "hold": "rgba(0,158,115,0.18)",
    "cycling": "rgba(86,180,233,0.16)",
}

Kind = Literal[
    "time", "length", "small length", "tension", "strain", "stress", "energy", "area", "frequency",
    "number",
]  # fmt: skip
"""Quantity on an axis or in a column; a diameter is a small length and is not shown in feet."""

_SI_UNIT: dict[Kind, str] = {
    "time": "s",
    "length": "m",
    "small length": "m",
    "tension": "N",
    "stress": "Pa",
    "energy": "J m-1",
    "area": "m2",
    "frequency": "Hz",
    "number": "1",
}

# a prefix where the SI unit alone would need a power of ten on every tick
_PREFIXED: dict[Kind, tuple[str, float]] = {
    "stress": ("MPa", 1e-6),
    "small length": ("mm", 1e3),
    "area": ("mm²", 1e6),
    "energy": ("J/m", 1.0),
}

_KIND_OF_UNIT: dict[str, Kind] = {
    "N": "tension", "Pa": "stress", "s": "time", "Hz": "frequency", "J m-1": "energy",
    "m": "small length", "m2": "area", "1": "number",
}  # fmt: skip

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

_TAKE_PREFIX = ("N", "Pa", "J/m")

_INCHES_IN_A_FOOT = 12.0


@dataclass(frozen=True)
class Shown:
    """Display form of a kind of quantity: unit to print and factor from SI to it."""

    unit: str
    factor: float

    def label(self, words: str) -> str:
        """Words followed by the unit in brackets, for an axis or a column."""
        return f"{words} [{self.unit}]"


DEGREES = Shown("deg", 180 / np.pi)

PERCENT = Shown("%", 100.0)


def shown(kind: Kind, system: UnitSystem) -> Shown:
    """Return the display unit of a kind of quantity.

    Examples
    --------
    >>> shown("stress", "si")
    Shown(unit='MPa', factor=1e-06)
    >>> shown("strain", "us").label("strain")
    'strain [%]'
    """
    if kind == "strain":
        return PERCENT
    if system == "si" and kind in _PREFIXED:
        return Shown(*_PREFIXED[kind])
    unit, factor = display_unit(_SI_UNIT[kind], system)
    if kind == "small length":
        return Shown("in", factor * _INCHES_IN_A_FOOT)
    return Shown({"in2": "in²"}.get(unit, unit), factor)


def shown_unit(unit: str, system: UnitSystem) -> Shown:
    """Return the display form of an SI unit; lengths as small ones, angles in degrees.

    Examples
    --------
    >>> shown_unit("Pa", "si"), shown_unit("N s", "us").unit
    (Shown(unit='MPa', factor=1e-06), 'lbf s')
    """
    if unit == "rad":
        return DEGREES
    if unit in _KIND_OF_UNIT:
        return shown(_KIND_OF_UNIT[unit], system)
    return Shown(*display_unit(unit, system))


def with_prefix(unit: Shown, greatest: float) -> Shown:
    """Return an SI unit with the prefix that leaves at most five digits before the point.

    Examples
    --------
    >>> with_prefix(Shown("N", 1.0), 2.2e8), with_prefix(Shown("lbf", 0.2248), 2.2e8)
    (Shown(unit='MN', factor=1e-06), Shown(unit='lbf', factor=0.2248))
    """
    if unit.unit not in _TAKE_PREFIX:
        return unit
    prefixed = ((1e7, "M", 1e-6), (1e4, "k", 1e-3))
    for least, letter, factor in prefixed:
        if abs(greatest) * unit.factor >= least:
            return Shown(f"{letter}{unit.unit}", unit.factor * factor)
    return unit


def colour(index: int) -> str:
    """Return the colour of the specimen or test with this index."""
    return COLOURS[index % len(COLOURS)]


def symbol(index: int) -> str:
    """Return the marker of the specimen or test with this index."""
    return SYMBOLS[index % len(SYMBOLS)]


def marker(index: int, *, variant: int = 0, size: int = 6) -> dict[str, Any]:
    """Return the marker of a test: colour and symbol by its index, filling by its specimen.

    Examples
    --------
    >>> marker(8, variant=1)
    {'color': '#D55E00', 'symbol': 'circle-open', 'size': 6}
    """
    filling = FILLINGS[variant % len(FILLINGS)]
    return {"color": colour(index), "symbol": symbol(index) + filling, "size": size}


def marked(index: int, variant: int = 0) -> dict[str, Any]:
    """Return the style of a few markers on a test's line, since there are only seven colours."""
    return {
        "mode": "lines+markers",
        "marker": {**marker(index, variant=variant), "maxdisplayed": 6},
    }


def superscript(unit: str) -> str:
    """Return a unit with superscript powers.

    Examples
    --------
    >>> superscript("N Hz-2")
    'N Hz⁻²'
    """
    if unit == "1":
        return unit
    return re.sub(r"-?\d+", lambda power: power[0].translate(_RAISED), unit)


def faded(hex_colour: str, alpha: float) -> str:
    """Return a colour with an opacity, for bands.

    Examples
    --------
    >>> faded("#0072B2", 0.2)
    'rgba(0,114,178,0.2)'
    """
    red, green, blue = (int(hex_colour[place : place + 2], 16) for place in (1, 3, 5))
    return f"rgba({red},{green},{blue},{alpha:g})"


def shorten(text: str, limit: int) -> str:
    r"""Return text on one line, with an ellipsis where it is longer than the limit.

    Examples
    --------
    >>> shorten("a very\nlong name", 8)
    'a very…'
    """
    line = " ".join(text.split())
    return line if len(line) <= limit else line[: limit - 1].rstrip() + "…"


def plot_text(text: str, limit: int = 36) -> str:
    """Return text that plotly draws literally, on one line and of bounded length.

    Examples
    --------
    >>> plot_text("<b>new</b> & used")
    '&lt;b&gt;new&lt;/b&gt; &amp; used'
    """
    line = shorten(text, limit)
    return line.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


NOT_GIVEN = "\N{EN DASH}"

_LEAST_LEADING = 2.0

_LEAST_PROBABILITY = 1e-4

_MISSING = 1e-3

_NOISE = 1e-12
"""A vanishing sum of numbers of order one ends at about 1e-16, in percent at 1e-14."""


@dataclass(frozen=True)
class TableCell:
    """One cell: text as shown, the archive's own value, and whether it is a number.

    ``factors`` are the coverage factors of the uncertainties that the text shows.
    """

    text: str
    value: str = ""
    is_number: bool = False
    factors: tuple[float, ...] = ()


@dataclass(frozen=True)
class PageTable:
    """A table; the first cell of a row is its heading.

    ``caption`` and ``remarks``, shown below the table, are plain text.
    """

    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[TableCell, ...], ...]
    is_tall: bool = False
    remarks: tuple[str, ...] = ()
    is_compact: bool = False

    @cached_property
    def number_columns(self) -> tuple[bool, ...]:
        """Which columns hold numbers: they are right-aligned, including the header."""
        return tuple(
            any(row[place].is_number for row in self.rows) for place in range(len(self.columns))
        )


def make_table(
    caption: str,
    columns: Sequence[str],
    rows: Sequence[Sequence[TableCell]],
    *,
    is_tall: bool = False,
    remarks: Sequence[str] = (),
    is_compact: bool = False,
) -> PageTable:
    """Return a table, its missing numbers aligned with the others."""
    cells = tuple(tuple(row) for row in rows)
    headings = tuple(map(_without_unit_of_one, columns))
    plain = PageTable(caption, headings, cells, is_tall, tuple(remarks), is_compact)
    missing = TableCell(NOT_GIVEN, is_number=True)
    aligned = tuple(
        tuple(
            missing if is_number and cell.text == NOT_GIVEN else cell
            for cell, is_number in zip(row, plain.number_columns, strict=True)
        )
        for row in plain.rows
    )
    return replace(plain, rows=aligned)


def words(text: str) -> TableCell:
    """Return a cell of text."""
    return TableCell(_without_unit_of_one(text) or NOT_GIVEN)


def _without_unit_of_one(text: str) -> str:
    """Omit the unit of a dimensionless number in a table; an axis shows it."""
    return text.removesuffix(" [1]")


def number(value: float, unit: Shown | None = None, *, digits: int = 4) -> TableCell:
    """Return a cell with one number, to so many digits."""
    scale = 1.0 if unit is None else unit.factor
    return TableCell(number_text(value * scale, digits), _exact(value), is_number=True)


def percent_cell(share: float) -> TableCell:
    """Return a cell with a share in percent."""
    return TableCell(f"{100 * share:.1f}", repr(share), is_number=True)


def count(value: float) -> TableCell:
    """Return a cell with a count."""
    text = f"{value:,.0f}" if isfinite(value) else NOT_GIVEN
    return TableCell(text, f"{value:.0f}" if isfinite(value) else "", is_number=True)


def number_text(value: float, digits: int = 4) -> str:
    """Return a number to so many digits, without a power of ten where it is readable without.

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
) -> TableCell:
    """Return a cell of a value and its expanded uncertainty, to two digits of the latter.

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
        return TableCell(NOT_GIVEN, "", is_number=True)
    if not isfinite(uncertainty) or uncertainty <= 0:
        return number(value, unit)
    half = uncertainty * scale
    factors = (factor,) if isfinite(factor) else ()
    if max(abs(value * scale), half) < _NOISE:
        return number(value, unit)
    if not 1e-10 <= half < 1e9:
        text = f"{value * scale:.4g} ± {half:.2g}"
        return TableCell(text, _exact(value), is_number=True, factors=factors)
    leading = half / 10.0 ** floor(log10(half))
    places = places_of(half, 1 if is_short and leading >= _LEAST_LEADING else 2)
    shown = f"{fixed_number(value * scale, places)} ± {fixed_number(half, places)}"
    return TableCell(shown, _exact(value), is_number=True, factors=factors)


def within(value: float, low: float, high: float, unit: Shown) -> TableCell:
    """Return a cell with a value and its interval, which need not be symmetric.

    Examples
    --------
    >>> within(4.8101, 3.8163, 6.4818, Shown("s", 1.0)).text
    '4.8 (3.8 to 6.5)'
    """
    shown, ends = with_interval(value, low, high, unit)
    return TableCell(f"{shown.text} ({ends.text})", shown.value, is_number=True)


def with_interval(
    value: float, low: float, high: float, unit: Shown
) -> tuple[TableCell, TableCell]:
    """Return a cell with a value and one with its interval, to two digits of the half width.

    Examples
    --------
    >>> [cell.text for cell in with_interval(156633.2, 155595.0, 157671.0, Shown("N", 1.0))]
    ['156,600', '155,600 to 157,700']
    """
    if not (isfinite(low) and isfinite(high)):
        return number(value, unit), TableCell(NOT_GIVEN, is_number=True)
    places = places_of((high - low) / 2 * unit.factor, 2)
    shown, *ends = (fixed_number(one * unit.factor, places) for one in (value, low, high))
    interval = TableCell(" to ".join(ends), f"{_exact(low)} {_exact(high)}", is_number=True)
    return TableCell(shown, _exact(value), is_number=True), interval


def factors_of(rows: Iterable[Iterable[TableCell]]) -> list[float]:
    """Return the coverage factors of all uncertainties of a table.

    Examples
    --------
    >>> factors_of([[words("new"), measured(2.0, 0.4, factor=1.96)]])
    [1.96]
    """
    return [factor for row in rows for cell in row for factor in cell.factors]


def probability(value: float) -> TableCell:
    """Return a cell with a probability; below 0.0001 only as a bound.

    Examples
    --------
    >>> probability(0.0312).text, probability(2e-9).text
    ('0.0312', '<0.0001')
    """
    if not isfinite(value):
        return TableCell(NOT_GIVEN, is_number=True)
    text = "<0.0001" if value < _LEAST_PROBABILITY else f"{value:.4f}"
    return TableCell(text, _exact(value), is_number=True)


def f_text(value: float) -> str:
    """Return an F, a ratio of variances of few runs, to four digits.

    Examples
    --------
    >>> f_text(2412095.3), f_text(15.588)
    ('2,412,000', '15.59')
    """
    return number_text(float(f"{value:.3e}"))


def f_value(value: float) -> TableCell:
    """Return a cell with an F."""
    return TableCell(f_text(value), _exact(value), is_number=True)


def share_text(value: float) -> str:
    """Return a share with the first digits in which it differs from the whole.

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


def span(low: float, high: float, unit: Shown, *, places: int) -> TableCell:
    """Return a cell with a range, its ends to so many places, or to two digits of its width.

    Examples
    --------
    >>> span(0.0021, 0.0043, Shown("%", 100.0), places=0).text
    '0.21 to 0.43'
    """
    if not (isfinite(low) and isfinite(high)):
        return TableCell(NOT_GIVEN, "", is_number=True)
    ends = (low * unit.factor, high * unit.factor)
    places = max(places, places_of(ends[1] - ends[0], 2))
    text = " to ".join(fixed_number(end, places) for end in ends)
    return TableCell(text, f"{_exact(low)} {_exact(high)}", is_number=True)


def interval(low: float, high: float, unit: Shown | None = None, *, digits: int = 3) -> TableCell:
    """Return a cell with a range, each end to so many digits; empty where neither is known.

    Examples
    --------
    >>> interval(0.1, 12.5).text
    '0.100 to 12.5'
    """
    if not (isfinite(low) or isfinite(high)):
        return words("")
    scale = 1.0 if unit is None else unit.factor
    text = " to ".join(number_text(end * scale, digits) for end in (low, high))
    return TableCell(text, f"{low!r} {high!r}", is_number=True)


def _exact(value: float) -> str:
    return repr(float(value)) if isfinite(value) else ""


_BLUE, _VERMILION, _GREEN, _PURPLE, _ORANGE, _SKY, _GREY = COLOURS

_LOOKS: dict[str, tuple[str, str]] = {
    RANDOM: (_GREY, ""),
    "run_to_run": (_GREY, ""),
    "regression": (_GREY, "/"),
    "tension_gain": (_BLUE, ""),
    "tension_offset": (_BLUE, "/"),
    "tension_reversibility": (_BLUE, "x"),
    "position_gain": (_ORANGE, ""),
    "position_offset": (_ORANGE, "/"),
    "lag": (_PURPLE, ""),
    "strain_calibration": (_GREEN, ""),
    "splice_method": (_GREEN, "/"),
    "splice_law": (_GREEN, "+"),
    "splice_friction": (_GREEN, "|"),
    "splice_slip": (_ORANGE, "|"),
    "window": (_GREY, "."),
    "strain_gain": (_GREEN, "x"),
    "gauge_length": (_GREEN, "."),
    "diameter": (_VERMILION, ""),
    "quasi_static_fit": (_SKY, ""),
    "pull_rate": (_SKY, "/"),
    "drift_place": (_SKY, "x"),
    "temperature": (_VERMILION, "/"),
    "attached_mass": (_PURPLE, "/"),
    "linear_density": (_PURPLE, "x"),
    "machine_compliance": (_ORANGE, "x"),
}

_UNKNOWN = (_GREY, "x")

_NAMES = {"window": "regression window", "quasi_static_fit": "fit of the slow pull"}

_MEANINGS = {
    RANDOM: "scatter between cycles, noise, regression",
    "run_to_run": "scatter of runs at one point of the plan",
    "regression": "lack of fit of the surface beyond that",
    "tension_reversibility": "difference of falling and rising load",
    "lag": "time between the channels",
    "strain_calibration": "fit to the readings at the splice marks",
    "splice_method": "choice of the splice law",
    "splice_law": "which law the splices follow",
    "splice_friction": "friction in the splices",
    "splice_slip": "slip of the splices after their marks were read",
    "window": "blur by its width",
    "gauge_length": "gauge length",
    "strain_gain": "error of the strain method itself",
    "quasi_static_fit": "fit of the slow pull that gives K_0",
    "pull_rate": "a slow pull that is too fast for the relaxation time of the loops",
    "drift_place": "the part of a cycle in which the specimen creeps or relaxes",
    "temperature": "stiffness at the temperature of the test",
    "attached_mass": "inertia of the mass at a moving load cell",
    "linear_density": "inertia of the specimen itself",
    "machine_compliance": "compliance of frame, load cell and grips",
}


def in_order(names: Iterable[str]) -> list[str]:
    """Return sources in their order, those without a fixed place last.

    Examples
    --------
    >>> in_order({"diameter", "what_is_new", "random"})
    ['random', 'diameter', 'what_is_new']
    """
    places = {name: place for place, name in enumerate(_LOOKS)}
    return sorted(names, key=lambda name: (places.get(name, len(places)), name))


def source_words(name: str) -> str:
    """Return the name of a source for the reader; ``reduction budget`` prints the identifier.

    Examples
    --------
    >>> source_words("tension_gain")
    'tension gain'
    """
    return _NAMES.get(name, name.replace("_", " "))


def source_meanings(names: Iterable[str]) -> str:
    """Return explanations of those sources whose names are not self-explanatory.

    Examples
    --------
    >>> source_meanings(["tension_gain", "lag"])
    'Lag: time between the channels.'
    """
    told = [f"{source_words(name)}: {_MEANINGS[name]}" for name in names if name in _MEANINGS]
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def is_hatched(name: str) -> bool:
    """Return whether the bar of a source is hatched.

    Examples
    --------
    >>> is_hatched("tension_gain"), is_hatched("tension_offset")
    (False, True)
    """
    return bool(_LOOKS.get(name, _UNKNOWN)[1])


def bar_look(name: str) -> dict[str, Any]:
    """Return the marker of a bar: the colour and the hatching of its source.

    Examples
    --------
    >>> bar_look("tension_offset")["color"], bar_look("tension_offset")["pattern"]["shape"]
    ('#0072B2', '/')
    """
    colour, shape = _LOOKS.get(name, _UNKNOWN)
    return {
        "color": colour,
        "pattern": {
            "shape": shape, "fillmode": "overlay", "fgcolor": "#ffffff", "size": 7,
            "solidity": 0.35,
        },
        "line": {"width": 0.5, "color": "#ffffff"},
    }  # fmt: skip
