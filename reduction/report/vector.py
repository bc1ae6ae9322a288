"""A figure as SVG in the page itself: sharp on paper, and without a script.

It draws what `reduction.report.figure` makes for plotly: lines, bands, markers and bars of
uncertainty on one pair of axes.  Everything that is text is escaped here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import escape
from itertools import pairwise

from reduction.report.figure import Figure, Trace
from reduction.report.vectoraxes import DrawnAxis, axis_of, plain_label
from reduction.report.vectormarks import drawn_key, drawn_trace

_LEFT, _RIGHT, _TOP, _BOTTOM = 30.0, 12.0, 34.0, 44.0
_LEGEND_ROW, _LEGEND_KEY, _LETTER = 15.0, 34.0, 5.9
_FEWEST_LETTERS = 4
_BEYOND = 10.0
"""By how much the title of an axis may be longer than the axis."""
_TICK_SPACE = (74.0, 34.0)
_VERTICAL = {"yaxis": "y", "yaxis2": "y2"}
_KNOWN_AXES = {"xaxis", *_VERTICAL}
_KNOWN_TYPES = {"linear", "log"}
_KNOWN_MODES = {"lines", "markers", "lines+markers"}


def can_be_drawn(figure: Figure) -> bool:
    """Return whether a figure is lines and markers over one axis, in one or two panels."""
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
    panels = _panels(figure, shown, height)
    longest = max(one.longest for one, _ in panels)
    left = _LEFT + _LETTER * max(longest, _FEWEST_LETTERS)
    horizontal = axis_of(
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
            *(part for one in own for part in drawn_trace(one, horizontal, vertical)),
            "</g>",
        ]
    return "\n".join([*parts, *(part for _, drawn in legend for part in drawn), "</svg>"])


def _panels(
    figure: Figure, shown: Sequence[Trace], height: float
) -> list[tuple[DrawnAxis, list[Trace]]]:
    """Vertical axes one above the other, the lowest first, with what is drawn on each."""
    whole = height - _BOTTOM - _TOP
    found = []
    for name, key in _VERTICAL.items():
        own = [one for one in shown if one.get("yaxis", "y") == key]
        if name not in figure.layout and not own:
            continue
        low, high = figure.layout.get(name, {}).get("domain", (0.0, 1.0))
        drawn = axis_of(
            figure.layout.get(name, {}), (y for one in own for y in _heights(one)),
            first=height - _BOTTOM - low * whole, last=height - _BOTTOM - high * whole,
            most=int((high - low) * whole / _TICK_SPACE[1]) + 1,
        )  # fmt: skip
        found.append((drawn, own))
    return sorted(found, key=lambda panel: -panel[0].first)


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


def _frame(horizontal: DrawnAxis, vertical: DrawnAxis, *, is_lowest: bool) -> Iterator[str]:
    """Grid, ticks and the two axes; words below the lowest panel alone."""
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
        # a low panel has a long title all the same
        turn += f' style="font-size:{max(share, 0.6):.2f}em"'
    yield _text(14, middle, vertical.title, "middle", turn=turn)


def _titles(figure: Figure, height: float, horizontal: DrawnAxis) -> Iterator[str]:
    yield _text(horizontal.first, 14, figure.title, kind="title")
    if figure.synthetic:
        yield _text(horizontal.first, 28, "SYNTHETIC DATA", kind="synthetic")
    yield _text((horizontal.first + horizontal.last) / 2, height - 10, horizontal.title, "middle")


def _levels(figure: Figure, horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
    """Straight lines across the drawing; other shapes mark stretches of a record."""
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
            drawn += [*drawn_key(entries[name], start, y), _text(start + 28, y, name)]
        yield 8 + _LEGEND_ROW * (number + 1) - 4, drawn
