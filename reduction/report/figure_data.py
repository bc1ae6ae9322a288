"""Figures as plain plotly dictionaries, thinned without losing extremes.

A record of millions of rows is divided into intervals of equal width along its axis; the least and
the greatest sample of each interval are kept, at their own places.  A single spike therefore
cannot disappear, however long the record is.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from reduction.record.arrays import runs_of_true
from reduction.record.measurement import Floats, Integers
from reduction.report.text_style import faded, plot_text, shorten

Trace = dict[str, Any]

_DIGITS = 6

_TITLE_LENGTH = 60

_SMALLEST_EVEN, _LARGEST_EVEN = 1e-7, 1e22
"""Between these exponents the power of ten that leaves up to 12 integer digits is exact."""


@dataclass(frozen=True)
class Figure:
    """One figure: data for plotly, and the text around it.

    ``key`` is the anchor on the page, ``title`` and ``caption`` are plain text; ``spoken`` is
    additional text for a screen reader, in place of details that are only visible.
    """

    key: str
    title: str
    caption: str
    data: list[Trace]
    layout: dict[str, Any]
    height: int = 360
    is_wide: bool = False
    synthetic: bool = False
    spoken: str = ""

    @property
    def has_data(self) -> bool:
        """True where at least one trace has a finite point."""
        return any(any(value is not None for value in trace["y"]) for trace in self.data)

    @property
    def is_in_space(self) -> bool:
        """True for a three-dimensional figure, which plotly draws as an image."""
        return "scene" in self.layout

    @property
    def label(self) -> str:
        """Text for a screen reader."""
        names = [trace["name"] for trace in self.data if trace.get("showlegend", True)]
        flat = {**self.layout, **self.layout.get("scene", {})}
        axes = [
            flat[name]["title"]["text"].replace("<br>", " ")
            for name in flat
            if name.startswith(("xaxis", "yaxis", "zaxis")) and "title" in flat[name]
        ]
        prefix = "Synthetic data. " if self.synthetic else ""
        lines = ", ".join(dict.fromkeys(names))
        about = f"{prefix}{self.title}. Axes: {'; '.join(axes)}. Lines: {lines}."
        return f"{shorten(about, 600)} {self.spoken}".rstrip()

    def compact(self) -> Figure:
        """The same figure in less memory, for figures with lines of many tests each."""
        points = [{name: _Points(one[name]) for name in ("x", "y")} for one in self.data]
        return replace(self, data=[one | own for one, own in zip(self.data, points, strict=True)])

    def json(self) -> str:
        """JSON of the figure for a script element: no markup or line end can break out of it."""
        return script_json({"data": self.data, "layout": self.layout})


def if_any(figure: Figure) -> list[Figure]:
    """Return a figure in a list, which is empty where the figure has no data."""
    return [figure] if figure.has_data else []


def script_json(document: object) -> str:
    r"""Return JSON that is safe inside a script element.

    Examples
    --------
    >>> script_json("</script>")
    '"\\u003c/script\\u003e"'
    """
    text = json.dumps(document, allow_nan=False, separators=(",", ":"), default=_as_list)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _as_list(one: object) -> list[float | None]:
    if isinstance(one, _Points):
        return list(one)
    raise TypeError(f"a {type(one).__name__} has no JSON")


class _Points(Sequence[float | None]):
    """Numbers in a quarter of the memory of a list; None for missing ones."""

    def __init__(self, numbers: Sequence[float | None]) -> None:
        self._numbers = np.array(numbers, dtype=np.float64)

    def __len__(self) -> int:
        return len(self._numbers)

    def __iter__(self) -> Iterator[float | None]:
        return (None if math.isnan(one) else one for one in self._numbers.tolist())

    @overload
    def __getitem__(self, place: int) -> float | None: ...

    @overload
    def __getitem__(self, place: slice) -> list[float | None]: ...

    def __getitem__(self, place: int | slice) -> float | list[float | None] | None:
        return list(self)[place]


def plain_numbers(values: Floats, digits: int = _DIGITS) -> list[float | None]:
    """Return numbers rounded to a few digits, at most 12; None for those not finite.

    Examples
    --------
    >>> plain_numbers(np.array([1.23456789, np.nan]))
    [1.23457, None]
    """
    numbers = np.asarray(values, dtype=np.float64)
    size = np.abs(numbers)
    is_sized = (size >= _SMALLEST_EVEN) & (size < _LARGEST_EVEN)
    digits_left = np.floor(np.log10(size, where=is_sized, out=np.zeros_like(size))).astype(int) + 1
    power = digits - digits_left
    up, down = 10.0 ** np.maximum(power, 0), 10.0 ** np.maximum(-power, 0)
    whole = np.rint(np.where(is_sized, numbers, 0.0) * up / down)
    shown: list[float | None] = (whole * down / up).tolist()
    for place in np.flatnonzero(~is_sized).tolist():
        number = float(numbers[place])
        shown[place] = float(f"{number:.{digits}g}") if math.isfinite(number) else None
    return shown


def line(
    x: Floats,
    y: Floats,
    *,
    name: str,
    colour: str,
    dash: str = "solid",
    width: float = 1.8,
    x_digits: int = _DIGITS,
    **more: Any,
) -> Trace:
    """Return a line trace; ``name`` is plain text."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": plot_text(name),
        "x": plain_numbers(x, x_digits),
        "y": plain_numbers(y),
        "line": {"color": colour, "dash": dash, "width": width},
        **more,
    }


def band(
    x: Floats, low: Floats, high: Floats, *, name: str, colour: str, alpha: float, **more: Any
) -> Trace:
    """Return a filled band; it is broken where an edge is not finite."""
    finite = np.isfinite(x) & np.isfinite(low) & np.isfinite(high)
    outline_x: list[Floats] = []
    outline_y: list[Floats] = []
    for first, stop in runs_of_true(finite):
        outline_x += [x[first:stop], x[first:stop][::-1], np.array([np.nan])]
        outline_y += [high[first:stop], low[first:stop][::-1], np.array([np.nan])]
    return {
        "type": "scatter",
        "mode": "lines",
        "name": plot_text(name),
        "x": plain_numbers(np.concatenate(outline_x)) if outline_x else [],
        "y": plain_numbers(np.concatenate(outline_y)) if outline_y else [],
        "fill": "toself",
        "fillcolor": faded(colour, alpha),
        "line": {"width": 0, "color": faded(colour, alpha)},
        "hoverinfo": "skip",
        "showlegend": False,
        **more,
    }


def axis(label: str, **more: Any) -> dict[str, Any]:
    """Return an axis with its title; the unit is part of the label."""
    return {
        "title": {"text": label}, "hoverformat": ",.4~r", "exponentformat": "none",
        "separatethousands": True, **more,
    }  # fmt: skip


def named_axis(label: str, names: Sequence[str]) -> dict[str, Any]:
    """Return an axis of names, one at each whole number; a name may have several lines."""
    return {
        "title": {"text": label, "standoff": 12},
        "tickvals": list(range(len(names))),
        "ticktext": [
            "<br>".join(plot_text(line, _TITLE_LENGTH) for line in name.splitlines())
            for name in names
        ],
        "showgrid": False,
        "zeroline": False,
    }


def make_figure(
    key: str,
    title: str,
    caption: str,
    data: Sequence[Trace],
    *,
    synthetic: bool,
    height: int = 360,
    is_wide: bool = False,
    spoken: str = "",
    **layout: Any,
) -> Figure:
    """Return a figure; ``synthetic`` writes the words into the figure itself."""
    heading: dict[str, Any] = {"text": plot_text(title, _TITLE_LENGTH)}
    if synthetic:
        heading["subtitle"] = {"text": "SYNTHETIC DATA"}
    return replace(
        Figure(key, title, caption, list(data), {"title": heading, **layout}),
        height=height,
        is_wide=is_wide,
        synthetic=synthetic,
        spoken=spoken,
    )


POINTS = 2000
"""Greatest number of points of one trace; a screen has fewer columns."""


def keep_extremes(coordinate: Floats, *channels: Floats, limit: int = POINTS) -> NDArray[np.intp]:
    """Return the indices of the samples to draw, in order.

    Examples
    --------
    >>> tension = np.zeros(10000)
    >>> tension[1234] = 5.0
    >>> bool(1234 in keep_extremes(np.arange(10000.0), tension, limit=100))
    True
    """
    n_samples = coordinate.shape[0]
    gaps = [~np.isfinite(channel) for channel in channels]
    # least, greatest, and, where a channel has gaps, one sample of a gap for each interval
    share = sum(2 + bool(gap.any()) for gap in gaps)
    n_intervals = (limit - 2) // share if share else 0
    if n_samples <= limit:
        return np.arange(n_samples)
    interval = _intervals(coordinate, n_intervals)
    starts = np.flatnonzero(np.diff(interval, prepend=-1))
    kept = [np.array([0, n_samples - 1])]
    for channel, gap in zip(channels, gaps, strict=True):
        kept.append(_least(np.where(gap, np.inf, channel), interval, starts))
        kept.append(_least(np.where(gap, np.inf, -channel), interval, starts))
        if gap.any():
            missing = np.flatnonzero(gap)
            kept.append(missing[np.flatnonzero(np.diff(interval[missing], prepend=-1))])
    return np.unique(np.concatenate(kept))


def least_and_greatest(
    coordinate: Floats, channel: Floats, *, n_intervals: int = POINTS // 4
) -> tuple[Floats, Floats, Floats]:
    """Return the least and greatest values of a channel in intervals of equal width.

    Examples
    --------
    >>> wave = np.tile([1.0, 5.0, 2.0], 100)
    >>> middle, least, greatest = least_and_greatest(np.arange(300.0), wave, n_intervals=3)
    >>> print(middle, least, greatest)
    [ 49.5 149.5 249.5] [1. 1. 1.] [5. 5. 5.]
    """
    if not channel.size:
        return coordinate, channel, channel
    interval = _intervals(coordinate, n_intervals)
    starts = np.flatnonzero(np.diff(interval, prepend=-1))
    ends = np.append(starts[1:], channel.size) - 1
    middle = (coordinate[starts] + coordinate[ends]) / 2
    return middle, np.fmin.reduceat(channel, starts), np.fmax.reduceat(channel, starts)


def with_gaps(piece: Integers, *series: Floats) -> list[Floats]:
    """Insert a missing sample between pieces, so that no line is drawn across.

    Examples
    --------
    >>> print(*with_gaps(np.array([0, 0, 1]), np.array([1.0, 2.0, 9.0])))
    [ 1.  2. nan  9.]
    """
    places = np.flatnonzero(np.diff(piece)) + 1
    return [np.insert(values, places, np.nan) for values in series]


def _intervals(coordinate: Floats, n_intervals: int) -> NDArray[np.int64]:
    """Return the interval number of each sample, never decreasing."""
    finite = np.isfinite(coordinate)
    rising = np.maximum.accumulate(np.where(finite, coordinate, -np.inf))
    if not finite.any() or rising[-1] <= coordinate[finite][0]:
        # without a usable axis: equal numbers of samples instead
        rank = np.arange(coordinate.shape[0], dtype=np.int64)
        return np.asarray(rank * n_intervals // coordinate.shape[0])
    first = coordinate[finite][0]
    # in this order a sample on a whole-number edge belongs to the upper interval
    place = np.maximum(rising - first, 0.0) * n_intervals / (rising[-1] - first)
    return np.asarray(np.minimum(place.astype(np.int64), n_intervals - 1))


def _least(
    channel: Floats, interval: NDArray[np.int64], starts: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Return the index of the first least sample of each interval."""
    counts = np.diff(np.append(starts, channel.shape[0]))
    is_least = channel == np.repeat(np.minimum.reduceat(channel, starts), counts)
    hits = np.flatnonzero(is_least)
    return hits[np.flatnonzero(np.diff(interval[hits], prepend=-1))]
