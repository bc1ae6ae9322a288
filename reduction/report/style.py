"""One style for every figure: colours, lines, units on the axes, names that stay text.

Colours are those of Okabe and Ito [1]_, which readers with any common colour vision tell
apart; yellow and black are left out because one fades on white and the other on a dark
page.  The seventh is a grey, dark enough not to be taken for the green or the purple by who
sees no red or no green.  A test keeps its colour and its marker through the figures of a
campaign, where the filling of the marker is the specimen's; an ascending branch is solid and a
descending one dashed, so that print in grey loses nothing.

References
----------
.. [1] Okabe and Ito, Color Universal Design, University of Tokyo, 2008.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from reduction.units import UnitSystem, display_unit

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#686868")
DASHES = {"ascending": "solid", "descending": "dash"}
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
"""What an axis or a column shows; a diameter is a small length and is not shown in feet."""

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
# a prefix where the bare SI unit would need a power of ten on every tick
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
    """How a kind of quantity is shown: unit to print and factor from SI to it."""

    unit: str
    factor: float

    def label(self, words: str) -> str:
        """Words with the unit behind them in brackets, for an axis or a column."""
        return f"{words} [{self.unit}]"


DEGREES = Shown("deg", 180 / np.pi)
PERCENT = Shown("%", 100.0)


def shown(kind: Kind, system: UnitSystem) -> Shown:
    """Return the unit in which a kind of quantity is shown.

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
    """Return how a quantity of an SI unit is shown; a length as a small one, an angle in degrees.

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
    """Return an SI unit with the prefix that leaves five digits at most before the point.

    Parameters
    ----------
    unit : Shown
        Another unit, or one that has a prefix, stays as it is.
    greatest : float
        Size of what is shown in it. [SI]

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
    """Return the colour of the specimen or test with this index.

    They repeat after seven; what may be more goes by `marker` too.
    """
    return COLOURS[index % len(COLOURS)]


def symbol(index: int) -> str:
    """Return the marker of the specimen or test with this index.

    There is one marker more than there are colours, so that the pair of both repeats
    only after fifty-six.
    """
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
    """Return what puts a few markers of a test on its line: colours alone are seven."""
    return {
        "mode": "lines+markers",
        "marker": {**marker(index, variant=variant), "maxdisplayed": 6},
    }


def superscript(unit: str) -> str:
    """Return a unit with its powers raised.

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
    """Return text that plotly draws as it stands, on one line and of bounded length.

    Plotly reads a small set of markup in names and titles; a specimen called ``<b>``
    has to come out as those three characters.

    Examples
    --------
    >>> plot_text("<b>new</b> & used")
    '&lt;b&gt;new&lt;/b&gt; &amp; used'
    """
    line = shorten(text, limit)
    return line.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
