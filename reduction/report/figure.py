"""A figure as plain plotly dictionaries, and the few shapes that every figure is built from."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reduction.record import Floats
from reduction.report.style import faded, plot_text, shorten

Trace = dict[str, Any]
_DIGITS = 6
_TITLE_LENGTH = 60
_SMALLEST_EVEN, _LARGEST_EVEN = 1e-7, 1e22
"""Between these the power of ten that leaves up to 12 digits before the point is exact."""


@dataclass(frozen=True)
class Figure:
    """One figure: what plotly draws, and the words around it.

    ``key`` is the anchor on the page, ``title`` and ``caption`` are plain text; ``spoken`` is
    what a screen reader says besides, in place of what only the eye reads off.
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
        """True where it is drawn in three dimensions, which plotly does as a picture."""
        return "scene" in self.layout

    @property
    def label(self) -> str:
        """What a screen reader says."""
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

    def json(self) -> str:
        """The figure for a script element: no markup can close it, no line end can break it."""
        return script_json({"data": self.data, "layout": self.layout})


def script_json(document: object) -> str:
    r"""Return JSON that is safe inside a script element.

    Examples
    --------
    >>> script_json("</script>")
    '"\\u003c/script\\u003e"'
    """
    text = json.dumps(document, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def plain_numbers(values: Floats, digits: int = _DIGITS) -> list[float | None]:
    """Return numbers of a few digits, at most 12, None where one is not finite.

    As Python's format ``g`` has them, but for a number within rounding of the middle between two,
    which may become either.

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
    for run in np.split(np.arange(x.shape[0]), np.flatnonzero(np.diff(finite)) + 1):
        if run.size and finite[run[0]]:
            outline_x += [x[run], x[run[::-1]], np.array([np.nan])]
            outline_y += [high[run], low[run[::-1]], np.array([np.nan])]
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
    """Return an axis with its title; the unit is part of the label.

    A number on it is written out: the thousands of plotly are a k that reads like a unit, and a
    logarithmic axis takes the format of the pointer for its ticks.
    """
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
    """Return a figure; ``synthetic`` puts the words into the figure itself.

    They stay with it when a reader saves it as a picture.
    """
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
