"""A figure as SVG in the page itself: sharp on paper, and without a script.

It draws what `reduction.report.figure` makes for plotly: lines, bands, markers and bars of
uncertainty on one pair of axes.  Everything that is text is escaped here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import escape
from itertools import pairwise
from math import ceil, isfinite
from typing import Any

from reduction.report.figure import Figure, Trace
from reduction.report.vectoraxes import DrawnAxis, axis_of, plain_label

__all__ = ["can_be_drawn", "vector_of"]

_LEFT, _RIGHT, _TOP, _BOTTOM = 30.0, 12.0, 34.0, 44.0
_LEGEND_ROW, _LEGEND_KEY, _LETTER = 15.0, 34.0, 5.9
_FEWEST_LETTERS = 4
_TICK_SPACE = (74.0, 34.0)
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
_KNOWN_AXES = {"xaxis", "yaxis"}
_KNOWN_TYPES = {"linear", "log"}
_KNOWN_MODES = {"lines", "markers", "lines+markers"}


def can_be_drawn(figure: Figure) -> bool:
    """Return whether a figure is lines and markers on one pair of axes of numbers or names."""
    axes = {name for name in figure.layout if name.lstrip("xy").startswith("axis")}
    return (
        figure.has_data
        and axes <= _KNOWN_AXES
        and "scene" not in figure.layout
        and all(figure.layout[name].get("type", "linear") in _KNOWN_TYPES for name in axes)
        and all(
            trace["type"] == "scatter" and trace.get("mode") in _KNOWN_MODES
            for trace in figure.data
        )
    )


def vector_of(figure: Figure, *, width: float = 680.0, height: float = 330.0) -> str:
    """Return a figure as an SVG element.

    What plotly draws only on a click is left out; so is what lies outside the axes.

    Parameters
    ----------
    figure : Figure
        One that `can_be_drawn`.
    width, height : float
        Of the drawing without its legend; on paper it is scaled to its column.
    """
    shown = [one for one in figure.data if one.get("visible", True) is True and one["y"]]
    vertical = axis_of(
        figure.layout.get("yaxis", {}), (y for one in shown for y in _heights(one)),
        first=height - _BOTTOM, last=_TOP, most=int((height - _TOP - _BOTTOM) / _TICK_SPACE[1]) + 1,
    )  # fmt: skip
    left = _LEFT + _LETTER * max(vertical.longest, _FEWEST_LETTERS)
    horizontal = axis_of(
        figure.layout.get("xaxis", {}), (x for one in shown for x in one["x"]),
        first=left, last=width - _RIGHT, most=int((width - left - _RIGHT) / _TICK_SPACE[0]) + 1,
    )  # fmt: skip
    legend = list(_legend(shown, left, width, height))
    total = height + (legend[-1][0] if legend else 0.0)
    clip = f"{figure.key}-clip"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 {width:g} {total:g}"'
        f' aria-label="{escape(replace(figure, data=shown).label)}">',
        f'<clipPath id="{escape(clip)}"><rect x="{left:g}" y="{_TOP:g}"'
        f' width="{horizontal.last - left:g}" height="{vertical.first - _TOP:g}"/></clipPath>',
        *_frame(horizontal, vertical),
        f'<g clip-path="url(#{escape(clip)})">',
        *_levels(figure, horizontal, vertical),
        *(part for one in shown for part in _drawn(one, horizontal, vertical)),
        "</g>",
        *_titles(figure, width, height, horizontal, vertical),
        *(part for _, drawn in legend for part in drawn),
        "</svg>",
    ]
    return "\n".join(parts)


def _heights(trace: Trace) -> list[float | None]:
    """Numbers along the vertical axis, bars of uncertainty and all."""
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


def _frame(horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
    """Grid, ticks and the two axes."""
    bottom, top = vertical.first, vertical.last
    for tick in horizontal.ticks:
        x = horizontal.at(tick.value)
        yield f'<path class="grid" d="M{x:.1f} {bottom:.1f}V{top:.1f}"/>'
        for row, line in enumerate(tick.lines):
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


def _titles(
    figure: Figure, width: float, height: float, horizontal: DrawnAxis, vertical: DrawnAxis
) -> Iterator[str]:
    yield _text(horizontal.first, 14, figure.title, kind="title")
    if figure.synthetic:
        yield _text(horizontal.first, 28, "SYNTHETIC DATA", kind="synthetic")
    yield _text((horizontal.first + horizontal.last) / 2, height - 10, horizontal.title, "middle")
    middle = (vertical.first + vertical.last) / 2
    turn = f' transform="rotate(-90 14 {middle:.1f})"'
    yield _text(14, middle, vertical.title, "middle", turn=turn)


def _levels(figure: Figure, horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
    """Straight lines across the drawing; other shapes mark stretches of a record."""
    for shape in figure.layout.get("shapes", ()):
        if shape.get("type") == "line" and shape.get("xref", "x") == "paper":
            y0, y1 = vertical.at(shape["y0"]), vertical.at(shape["y1"])
            yield (
                f'<path class="level" d="M{horizontal.first:.1f} {y0:.1f}'
                f'L{horizontal.last:.1f} {y1:.1f}"/>'
            )


def _runs(trace: Trace, horizontal: DrawnAxis, vertical: DrawnAxis) -> list[list[str]]:
    """Places of the points, parted where one is missing."""
    runs: list[list[str]] = [[]]
    for x, y in zip(trace["x"], trace["y"], strict=True):
        if x is None or y is None or not (isfinite(x) and isfinite(y)):
            if runs[-1]:
                runs.append([])
            continue
        place = horizontal.at(x), vertical.at(y)
        if all(map(isfinite, place)):  # zero has no place on a logarithmic axis
            runs[-1].append(f"{place[0]:.2f} {place[1]:.2f}")
    return [run for run in runs if run]


def _drawn(trace: Trace, horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
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


def _stroke(trace: Trace) -> str:
    style = trace.get("line", {})
    colour = style.get("color", trace.get("marker", {}).get("color", "#333333"))
    dash = _DASHES.get(style.get("dash", "solid"))
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return f' stroke="{escape(str(colour))}" stroke-width="{style.get("width", 1.8):g}"{dashed}'


def _bars(trace: Trace, horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
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


def _legend(
    shown: Sequence[Trace], left: float, width: float, height: float
) -> Iterator[tuple[float, list[str]]]:
    """Rows below the drawing: how far down each reaches, and what it is."""
    entries: dict[str, Trace] = {}
    for trace in shown:
        if trace.get("showlegend", True) and trace.get("name"):
            entries.setdefault(plain_label(trace["name"]), trace)
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
            drawn += [*_key(entries[name], start, y), _text(start + 28, y, name)]
        yield 8 + _LEGEND_ROW * (number + 1) - 4, drawn


def _key(trace: Trace, x: float, y: float) -> Iterator[str]:
    """What stands before a name: a piece of its line, its marker, a patch of its band."""
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
