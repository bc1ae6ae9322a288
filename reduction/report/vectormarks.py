"""What a trace leaves on a drawing: lines, bands, markers, bars, and its key in a legend."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from math import ceil, isfinite
from typing import Any

from reduction.report.figure import Trace
from reduction.report.vectoraxes import DrawnAxis

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


def drawn_trace(trace: Trace, horizontal: DrawnAxis, vertical: DrawnAxis) -> Iterator[str]:
    """Give the elements of one trace on its axes."""
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


def drawn_key(trace: Trace, x: float, y: float) -> Iterator[str]:
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
