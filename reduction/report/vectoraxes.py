"""Axes of a figure that is drawn without a script: range, ticks, and where a number stands."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, floor, isfinite, log10, nan
from typing import Any

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_MARGIN = 0.04
_ROUNDING = 1e-9
_MARKUP = re.compile(r"<br\s*/?>")


@dataclass(frozen=True)
class Tick:
    """A mark on an axis with its words, a line each."""

    value: float
    lines: tuple[str, ...]


@dataclass(frozen=True)
class DrawnAxis:
    """One axis: its ends and ticks, and the places of the ends on the drawing.

    ``low`` and ``high`` of a logarithmic axis are powers of ten.
    """

    title: str
    low: float
    high: float
    first: float
    last: float
    ticks: tuple[Tick, ...]
    is_log: bool = False

    @property
    def longest(self) -> int:
        """Letters of the longest words at a tick."""
        return max((len(line) for tick in self.ticks for line in tick.lines), default=0)

    def at(self, value: float) -> float:
        """Place of a number on the drawing; NaN where a logarithmic axis has none."""
        if self.is_log:
            value = log10(value) if value > 0 else nan
        share = (value - self.low) / (self.high - self.low)
        return self.first + share * (self.last - self.first)


def round_ticks(low: float, high: float, most: int) -> list[float]:
    """Return round numbers between two ends, at most so many and as many as fit.

    Examples
    --------
    >>> print(round_ticks(0.0, 1.3, 6))
    [0.0, 0.25, 0.5, 0.75, 1.0, 1.25]
    """
    least = (high - low) / max(most, 2)
    power = 10.0 ** floor(log10(least))
    for step in (power * one for one in _STEPS):
        first, last = ceil(low / step - _ROUNDING), floor(high / step + _ROUNDING)
        if last - first + 1 <= most:
            break
    decimals = max(0, 1 - floor(log10(step)))
    return [round(number * step, decimals) + 0.0 for number in range(first, last + 1)]


def plain_label(text: str) -> str:
    """Return what plotly would show of a title or a name, on one line.

    Examples
    --------
    >>> plain_label("&lt;b&gt; and<br>stress [MPa]")
    '<b> and stress [MPa]'
    """
    return html.unescape(_MARKUP.sub(" ", text))


def axis_of(
    layout: Mapping[str, Any], values: Iterable[float | None], *, first: float, last: float,
    most: int,
) -> DrawnAxis:  # fmt: skip
    """Return an axis as plotly would lay it out, linear or logarithmic.

    Parameters
    ----------
    layout : mapping
        Of the axis: ``title``, ``type``, ``range``, ``rangemode``, ``tickvals`` with ``ticktext``.
    values : iterable of float or None
        All that is drawn along it.
    first, last : float
        Where its ends stand on the drawing.
    most : int
        Ticks at most.
    """
    is_log = layout.get("type") == "log"
    known = [one for one in values if one is not None and isfinite(one)]
    if is_log:
        known = [log10(one) for one in known if one > 0]
    low, high = _ends(layout, known)
    if "ticktext" in layout:
        pairs = zip(layout["tickvals"], layout["ticktext"], strict=True)
        ticks = [
            Tick(float(value), tuple(html.unescape(line) for line in _MARKUP.split(text)))
            for value, text in pairs
        ]
    elif is_log:
        ticks = list(_decades(low, high, most))
    else:
        ticks = [Tick(value, (_number(value),)) for value in round_ticks(low, high, most)]
    title = plain_label(layout.get("title", {}).get("text", ""))
    return DrawnAxis(title, low, high, first, last, tuple(ticks), is_log)


def _ends(layout: Mapping[str, Any], known: Sequence[float]) -> tuple[float, float]:
    given = layout.get("range")
    if given is not None:
        return float(given[0]), float(given[1])
    low, high = (min(known), max(known)) if known else (0.0, 1.0)
    if low == high:
        half = abs(low) / 2 or 1.0
        return low - half, high + half
    margin = _MARGIN * (high - low)
    if layout.get("rangemode") == "tozero":
        return (
            min(0.0, low - margin if low < 0 else 0.0),
            max(0.0, high + margin if high > 0 else 0.0),
        )
    return low - margin, high + margin


def _decades(low: float, high: float, most: int) -> Iterator[Tick]:
    """Give powers of ten, with 2 and 5 between them where there is room."""
    powers = range(floor(low), ceil(high) + 1)
    leading = (1, 2, 5) if 3 * (high - low) <= most else (1,)
    every = ceil((high - low) / most) if len(leading) == 1 else 1
    for power in powers[:: max(every, 1)]:
        for digit in leading:
            value = digit * 10.0**power
            if low - _ROUNDING <= log10(value) <= high + _ROUNDING:
                yield Tick(value, (_number(value),))


def _number(value: float) -> str:
    text = f"{value:,.10g}" if 1e-4 <= abs(value) < 1e9 or value == 0 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")
