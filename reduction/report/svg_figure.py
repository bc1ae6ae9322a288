"""Figures as SVG, without a script.

It draws what `reduction.report.figure_data` makes for plotly: lines, bands, markers and bars of
uncertainty on one pair of axes.  Everything that is text is escaped here.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from itertools import pairwise
from math import ceil, floor, isfinite, log10, nan
from typing import Any

from reduction.report.figure_data import Figure, Trace

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)

_MARGIN = 0.04

_ROUNDING = 1e-9

_MARKUP = re.compile(r"<br\s*/?>")


@dataclass(frozen=True)
class _Tick:
    """A mark on an axis with its label, one entry per line."""

    value: float
    lines: tuple[str, ...]


@dataclass(frozen=True)
class _DrawnAxis:
    """One axis: its ends and ticks, and the positions of the ends on the drawing."""

    title: str
    low: float
    high: float
    first: float
    last: float
    ticks: tuple[_Tick, ...]
    is_log: bool = False

    @property
    def longest(self) -> int:
        """Number of letters of the longest tick label."""
        return max((len(line) for tick in self.ticks for line in tick.lines), default=0)

    def at(self, value: float) -> float:
        """Position of a number on the drawing; NaN where a logarithmic axis has none."""
        if self.is_log:
            value = log10(value) if value > 0 else nan
        share = (value - self.low) / (self.high - self.low)
        return self.first + share * (self.last - self.first)


def _round_ticks(low: float, high: float, most: int) -> list[float]:
    """Return round numbers between two ends, as many as fit up to a greatest number.

    Examples
    --------
    >>> print(_round_ticks(0.0, 1.3, 6))
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


def _plain_label(text: str) -> str:
    """Return a title or name as plotly would show it, on one line.

    Examples
    --------
    >>> _plain_label("&lt;b&gt; and<br>stress [MPa]")
    '<b> and stress [MPa]'
    """
    return html.unescape(_MARKUP.sub(" ", text))


def _axis_of(
    layout: Mapping[str, Any], values: Iterable[float | None], *, first: float, last: float,
    most: int,
) -> _DrawnAxis:  # fmt: skip
    """Return an axis with the layout of plotly, linear or logarithmic."""
    is_log = layout.get("type") == "log"
    known = [one for one in values if one is not None and isfinite(one)]
    if is_log:
        known = [log10(one) for one in known if one > 0]
    low, high = _ends(layout, known)
    if "ticktext" in layout:
        pairs = zip(layout["tickvals"], layout["ticktext"], strict=True)
        ticks = [
            _Tick(float(value), tuple(html.unescape(line) for line in _MARKUP.split(text)))
            for value, text in pairs
        ]
    elif is_log:
        ticks = list(_decades(low, high, most))
    else:
        ticks = [_Tick(value, (_number(value),)) for value in _round_ticks(low, high, most)]
    title = _plain_label(layout.get("title", {}).get("text", ""))
    return _DrawnAxis(title, low, high, first, last, tuple(ticks), is_log)


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


def _decades(low: float, high: float, most: int) -> Iterator[_Tick]:
    """Yield powers of ten, with 2 and 5 between them where there is room."""
    powers = range(floor(low), ceil(high) + 1)
    leading = (1, 2, 5) if 3 * (high - low) <= most else (1,)
    every = ceil((high - low) / most) if len(leading) == 1 else 1
    for power in powers[:: max(every, 1)]:
        for digit in leading:
            value = digit * 10.0**power
            if low - _ROUNDING <= log10(value) <= high + _ROUNDING:
                yield _Tick(value, (_number(value),))


def _number(value: float) -> str:
    text = f"{value:,.10g}" if 1e-4 <= abs(value) < 1e9 or value == 0 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")


_DASHES = {
    "dash": "6 3.5", "dot": "1.5 3", "dashdot": "6 3 1.5 3", "longdash": "10 4",
    "longdashdot": "10 4 1.5 4",
}  # fmt: skip

_SHAPES: dict[str, list[tuple[float, float]]] = {
    "square": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "diamond": [(0, -1.3), (1.3, 0), (0, 1.3), (-1.3, 0)],
    "triangle-up": [(0, -1.2), (1.15, 0.9), (-1.15, 0.9)],
    "triangle-down": [(0, 1.2), (1.15, -0.9), (-1.15, -0.9)],
    "cross": [(-0.4, -1.2), (0.4, -1.2), (0.4, -0.4), (1.2, -0.4), (1.2, 0.4), (0.4, 0.4),
              (0.4, 1.2), (-0.4, 1.2), (-0.4, 0.4), (-1.2, 0.4), (-1.2, -0.4), (-0.4, -0.4)],
    "x": [(-1.1, -0.6), (-0.6, -1.1), (0, -0.5), (0.6, -1.1), (1.1, -0.6), (0.5, 0), (1.1, 0.6),
          (0.6, 1.1), (0, 0.5), (-0.6, 1.1), (-1.1, 0.6), (-0.5, 0)],
    "star": [(0, -1.4), (0.35, -0.45), (1.35, -0.43), (0.57, 0.18), (0.83, 1.15), (0, 0.6),
             (-0.83, 1.15), (-0.57, 0.18), (-1.35, -0.43), (-0.35, -0.45)],
}  # fmt: skip

# half of each of two strokes
_CROSSES = {"x": ((1, 1), (1, -1)), "cross": ((1, 0), (0, 1))}


def _drawn_trace(trace: Trace, horizontal: _DrawnAxis, vertical: _DrawnAxis) -> Iterator[str]:
    """Yield the elements of one trace on its axes."""
    opacity = f' opacity="{trace["opacity"]:g}"' if "opacity" in trace else ""
    runs = _runs(trace, horizontal, vertical)
    if trace.get("fill") == "toself":
        path = "".join(f"M{'L'.join(run)}Z" for run in runs)
        yield f'<path fill="{escape(trace["fillcolor"])}" stroke="none" d="{path}"{opacity}/>'
        return
    if "lines" in trace["mode"]:
        path = "".join(f"M{'L'.join(run)}" for run in runs)
        yield f'<path fill="none"{_stroke(trace)} d="{path}"{opacity}/>'
    points = [run for one in runs for run in one]
    if "error_y" in trace:
        yield from _bars(trace, horizontal, vertical)
    marker = trace.get("marker", {})
    if "markers" in trace["mode"]:
        most = marker.get("maxdisplayed") or len(points) or 1
        for point in points[:: ceil(len(points) / most) or 1]:
            x, y = point.split()
            yield _marker(float(x), float(y), marker)


def _drawn_key(trace: Trace, x: float, y: float) -> Iterator[str]:
    """Symbol before a name: a piece of its line, its marker, a patch of its band."""
    middle = y - 3.6
    if trace.get("fill") == "toself":
        yield (
            f'<rect x="{x:.1f}" y="{middle - 4:.1f}" width="24" height="8"'
            f' fill="{escape(trace["fillcolor"])}"/>'
        )
        return
    if "lines" in trace["mode"]:
        yield f'<path fill="none"{_stroke(trace)} d="M{x:.1f} {middle:.1f}h24"/>'
    if "markers" in trace["mode"]:
        yield _marker(x + 12, middle, trace.get("marker", {}))


def _runs(trace: Trace, horizontal: _DrawnAxis, vertical: _DrawnAxis) -> list[list[str]]:
    """Positions of the points, split where one is missing."""
    runs: list[list[str]] = [[]]
    for x, y in zip(trace["x"], trace["y"], strict=True):
        if x is None or y is None or not (isfinite(x) and isfinite(y)):
            if runs[-1]:
                runs.append([])
            continue
        place = horizontal.at(x), vertical.at(y)
        if all(map(isfinite, place)):  # zero has no position on a logarithmic axis
            runs[-1].append(f"{place[0]:.2f} {place[1]:.2f}")
    return [run for run in runs if run]


def _stroke(trace: Trace) -> str:
    style = trace.get("line", {})
    colour = style.get("color", trace.get("marker", {}).get("color", "#333333"))
    dash = _DASHES.get(style.get("dash", "solid"))
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return f' stroke="{escape(str(colour))}" stroke-width="{style.get("width", 1.8):g}"{dashed}'


def _bars(trace: Trace, horizontal: _DrawnAxis, vertical: _DrawnAxis) -> Iterator[str]:
    colour = escape(str(trace.get("marker", {}).get("color", "#333333")))
    bars = trace["error_y"].get("array", ())
    for x, y, half in zip(trace["x"], trace["y"], bars, strict=False):
        if x is None or y is None or half is None:
            continue
        low, high = vertical.at(y - half), vertical.at(y + half)
        yield f'<path stroke="{colour}" d="M{horizontal.at(x):.1f} {low:.1f}V{high:.1f}"/>'


def _marker(x: float, y: float, style: dict[str, Any]) -> str:
    """One marker; an open one is drawn in outline."""
    colour = escape(str(style.get("color", "#333333")))
    radius = float(style.get("size", 6)) / 2
    name = str(style.get("symbol", "circle"))
    is_open = "-open" in name
    if "-thin" in name:
        strokes = [(radius * dx, radius * dy) for dx, dy in _CROSSES[name.partition("-thin")[0]]]
        ends = (f"M{x - dx:.1f} {y - dy:.1f}L{x + dx:.1f} {y + dy:.1f}" for dx, dy in strokes)
        return f'<path d="{"".join(ends)}" fill="none" stroke="{colour}"/>'
    paint = f'fill="{"#ffffff" if is_open else colour}" stroke="{colour}"'
    corners = _SHAPES.get(name.removesuffix("-dot").removesuffix("-open"))
    if corners is None:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" {paint}/>'
    path = "L".join(f"{x + radius * dx:.1f} {y + radius * dy:.1f}" for dx, dy in corners)
    return f'<path d="M{path}Z" {paint}/>'


_LEFT, _RIGHT, _TOP, _BOTTOM = 30.0, 12.0, 34.0, 44.0

_LEGEND_ROW, _LEGEND_KEY, _LETTER = 15.0, 34.0, 5.9

_FEWEST_LETTERS = 4

_BEYOND = 10.0
"""Length by which the title of an axis may exceed the axis."""

_TICK_SPACE = (74.0, 34.0)

_VERTICAL = {"yaxis": "y", "yaxis2": "y2"}

_KNOWN_AXES = {"xaxis", *_VERTICAL}

_KNOWN_TYPES = {"linear", "log"}

_KNOWN_MODES = {"lines", "markers", "lines+markers"}


def can_be_drawn(figure: Figure) -> bool:
    """Return whether a figure consists of lines and markers over one axis, in one or two panels."""
    axes = {name for name in figure.layout if name.lstrip("xy").startswith("axis")}
    return (
        figure.has_data
        and axes <= _KNOWN_AXES
        and "scene" not in figure.layout
        and ("yaxis2" not in axes or all("domain" in figure.layout[name] for name in _VERTICAL))
        and all(figure.layout[name].get("type", "linear") in _KNOWN_TYPES for name in axes)
        and all(
            trace["type"] == "scatter" and trace.get("mode") in _KNOWN_MODES
            for trace in figure.data
        )
    )


def vector_of(figure: Figure, *, width: float = 680.0, height: float = 330.0) -> str:
    """Return a figure as an SVG element."""
    shown = [one for one in figure.data if one.get("visible", True) is True and one["y"]]
    panels = _panels(figure, shown, height)
    longest = max(one.longest for one, _ in panels)
    left = _LEFT + _LETTER * max(longest, _FEWEST_LETTERS)
    horizontal = _axis_of(
        figure.layout.get("xaxis", {}), (x for one in shown for x in one["x"]),
        first=left, last=width - _RIGHT, most=int((width - left - _RIGHT) / _TICK_SPACE[0]) + 1,
    )  # fmt: skip
    legend = list(_legend(shown, left, width, height))
    total = height + (legend[-1][0] if legend else 0.0)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 {width:g} {total:g}"'
        f' aria-label="{escape(replace(figure, data=shown).label)}">',
        *_titles(figure, height, horizontal),
    ]
    for number, (vertical, own) in enumerate(panels):
        clip = escape(f"{figure.key}-clip-{number}")
        parts += [
            f'<clipPath id="{clip}"><rect x="{left:g}" y="{vertical.last:g}"'
            f' width="{horizontal.last - left:g}"'
            f' height="{vertical.first - vertical.last:g}"/></clipPath>',
            *_frame(horizontal, vertical, is_lowest=number == 0),
            f'<g clip-path="url(#{clip})">',
            *(_levels(figure, horizontal, vertical) if number == 0 else ()),
            *(part for one in own for part in _drawn_trace(one, horizontal, vertical)),
            "</g>",
        ]
    return "\n".join([*parts, *(part for _, drawn in legend for part in drawn), "</svg>"])


def _panels(
    figure: Figure, shown: Sequence[Trace], height: float
) -> list[tuple[_DrawnAxis, list[Trace]]]:
    """Vertical axes one above the other, the lowest first, with the traces on each."""
    whole = height - _BOTTOM - _TOP
    found = []
    for name, key in _VERTICAL.items():
        own = [one for one in shown if one.get("yaxis", "y") == key]
        if name not in figure.layout and not own:
            continue
        low, high = figure.layout.get(name, {}).get("domain", (0.0, 1.0))
        drawn = _axis_of(
            figure.layout.get(name, {}), (y for one in own for y in _heights(one)),
            first=height - _BOTTOM - low * whole, last=height - _BOTTOM - high * whole,
            most=int((high - low) * whole / _TICK_SPACE[1]) + 1,
        )  # fmt: skip
        found.append((drawn, own))
    return sorted(found, key=lambda panel: -panel[0].first)


def _heights(trace: Trace) -> list[float | None]:
    """Values along the vertical axis, including bars of uncertainty."""
    y = trace["y"]
    bars = trace.get("error_y", {}).get("array")
    if not bars:
        return list(y)
    pairs = [(v, b) for v, b in zip(y, bars, strict=True) if v is not None and b is not None]
    return [*y, *(v - b for v, b in pairs), *(v + b for v, b in pairs)]


def _text(
    x: float, y: float, words: str, anchor: str = "start", kind: str = "", turn: str = ""
) -> str:
    classes = f' class="{kind}"' if kind else ""
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f"<text {place}{classes}{turn}>{escape(words)}</text>"


def _frame(horizontal: _DrawnAxis, vertical: _DrawnAxis, *, is_lowest: bool) -> Iterator[str]:
    """Grid, ticks and the two axes; tick labels only below the lowest panel."""
    bottom, top = vertical.first, vertical.last
    for tick in horizontal.ticks:
        x = horizontal.at(tick.value)
        yield f'<path class="grid" d="M{x:.1f} {bottom:.1f}V{top:.1f}"/>'
        for row, line in enumerate(tick.lines if is_lowest else ()):
            is_beyond = x + _LETTER * len(line) / 2 > horizontal.last + _RIGHT
            place = (horizontal.last + _RIGHT, "end") if is_beyond else (x, "middle")
            yield _text(place[0], bottom + 14 + 12 * row, line, place[1])
    for tick in vertical.ticks:
        y = vertical.at(tick.value)
        yield f'<path class="grid" d="M{horizontal.first:.1f} {y:.1f}H{horizontal.last:.1f}"/>'
        yield _text(horizontal.first - 6, y + 3.6, " ".join(tick.lines), "end")
    yield (
        f'<path class="axis" d="M{horizontal.first:.1f} {top:.1f}V{bottom:.1f}'
        f'H{horizontal.last:.1f}"/>'
    )
    middle = (bottom + top) / 2
    turn = f' transform="rotate(-90 14 {middle:.1f})"'
    share = (bottom - top + _BEYOND) / (_LETTER * max(len(vertical.title), 1))
    if share < 1:
        # a low panel may have a long title
        turn += f' style="font-size:{max(share, 0.6):.2f}em"'
    yield _text(14, middle, vertical.title, "middle", turn=turn)


def _titles(figure: Figure, height: float, horizontal: _DrawnAxis) -> Iterator[str]:
    yield _text(horizontal.first, 14, figure.title, kind="title")
    if figure.synthetic:
        yield _text(horizontal.first, 28, "SYNTHETIC DATA", kind="synthetic")
    yield _text((horizontal.first + horizontal.last) / 2, height - 10, horizontal.title, "middle")


def _levels(figure: Figure, horizontal: _DrawnAxis, vertical: _DrawnAxis) -> Iterator[str]:
    """Straight lines across the drawing; other shapes mark parts of a record."""
    for shape in figure.layout.get("shapes", ()):
        if shape.get("type") == "line" and shape.get("xref", "x") == "paper":
            y0, y1 = vertical.at(shape["y0"]), vertical.at(shape["y1"])
            yield (
                f'<path class="level" d="M{horizontal.first:.1f} {y0:.1f}'
                f'L{horizontal.last:.1f} {y1:.1f}"/>'
            )


def _legend(
    shown: Sequence[Trace], left: float, width: float, height: float
) -> Iterator[tuple[float, list[str]]]:
    """Rows below the drawing: the lower end of each, and its content."""
    entries: dict[str, Trace] = {}
    for trace in shown:
        if trace.get("showlegend", True) and trace.get("name"):
            entries.setdefault(_plain_label(trace["name"]), trace)
    if len(entries) < 2:
        return
    sizes = {name: _LEGEND_KEY + _LETTER * len(name) + 12 for name in entries}
    rows: list[list[str]] = [[]]
    used = 0.0
    for name in entries:
        if rows[-1] and used + sizes[name] > width - left:
            rows.append([])
            used = 0.0
        rows[-1].append(name)
        used += sizes[name]
    for number, row in enumerate(rows):
        y = height + 8 + _LEGEND_ROW * number
        starts = [left + sum(sizes[one] for one in row[:place]) for place in range(len(row) + 1)]
        drawn = []
        for name, (start, _) in zip(row, pairwise(starts), strict=True):
            drawn += [*_drawn_key(entries[name], start, y), _text(start + 28, y, name)]
        yield 8 + _LEGEND_ROW * (number + 1) - 4, drawn
