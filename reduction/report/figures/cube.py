"""The cube of three factors with the value of a surface at its corners, edges and centre.

As Figure 6 of [1]_, with what the runs say least of marked.

References
----------
.. [1] CG-D-39-80, sec. 4.4.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from reduction.record import Bools, Floats
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figure import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.figures.surfaces import base_response, scale_words
from reduction.report.htmltable import number_text, with_interval
from reduction.report.style import COLOURS, Shown, plot_text, with_prefix
from reduction.report.surfacegrid import leverage_ratio
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.product import ResponseSurfaces
from reduction.surface.tested import ABOVE_LEVERAGE

_GREY = "#8C8C8C"
_DEPTH = (0.46, 0.34)
"""By which the back of the cube is shifted right and up."""


def draw_cube(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> list[Figure]:
    """Draw the cube of three factors with the value at its corners, edges and centre."""
    name = surfaces.response_names[index]
    if len(view.factors) != 3:
        return []
    unit = response_unit(base_response(name), view.units)
    words = in_words(base_response(name))
    # x across, y up, z away: mean tension, the last factor and the held one
    order = [k for k in range(3) if view.factors[k] != "frequency"][:2]
    order.append(next(k for k in range(3) if k not in order))
    grid = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))
    n_middle = (grid == 0).sum(axis=1)
    grid = grid[n_middle != 2]  # no middle of a face
    coded = np.empty_like(grid)
    coded[:, order] = grid
    at = evaluate_surfaces(surfaces, coded, units="coded")
    value = at.value[index] * unit.factor
    if not np.isfinite(value).any():
        return []
    place = _projected(grid)
    ratio = leverage_ratio(view, surfaces, at)[index]
    shown = with_prefix(unit, float(np.nanmax(np.abs(at.value[index]))))
    texts = _short_texts(at.value[index], at.confidence_interval[index], shown)
    data = [*_edges(), *_cube_points(place, texts, ratio > ABOVE_LEVERAGE)]
    ends = [
        f"{in_words(view.factors[k])} {number_text(view.levels(k)[0], 3)} to"
        f" {number_text(view.levels(k)[2], 3)} {view.factor_units[k].unit}"
        for k in order
    ]
    return [
        make_figure(
            f"{view.key}-{name}-cube", f"{view.name}: {words} on the cube",
            f"Value of the surface of the {words}{scale_words(name)} at corners, edges and centre"
            f" [{shown.unit}]: to the right {ends[0]}, upward {ends[1]}, away {ends[2]}. Open"
            " markers: the runs say less there than at the worst of them. A value ends at the"
            " second digit of half its 95 % interval.",
            data, synthetic=view.is_synthetic, height=430,
            xaxis={
                **axis(f"{view.factor_label(order[0])}, low to high"),
                "range": [-0.25, 1.75], "showgrid": False, "zeroline": False,
                "showticklabels": False, "showline": False, "ticks": "",
            },
            yaxis={
                **axis(f"{view.factor_label(order[1])}, low to high"),
                "range": [-0.12, 1.5], "showgrid": False, "zeroline": False,
                "showticklabels": False, "showline": False, "ticks": "",
            },
            annotations=[_away(view, order[2])],
        )
    ]  # fmt: skip


def _projected(grid: Floats) -> Floats:
    """Return places on paper of points of the cube, shape (n_points, 2)."""
    unit = (grid + 1) / 2
    flat: Floats = unit[:, :2] + unit[:, 2:] * np.array(_DEPTH)
    return flat


def _edges() -> list[Trace]:
    """Return the twelve edges; the three that a solid cube would hide are dotted."""
    corners = np.array(list(product((-1.0, 1.0), repeat=3)))
    hidden_corner = np.array([-1.0, -1.0, 1.0])
    seen: list[Floats] = []
    hidden: list[Floats] = []
    for one, other in product(range(8), repeat=2):
        if one < other and np.abs(corners[one] - corners[other]).sum() == 2:
            ends = np.vstack([_projected(corners[[one, other]]), [np.nan, np.nan]])
            is_hidden = any((corners[k] == hidden_corner).all() for k in (one, other))
            (hidden if is_hidden else seen).append(ends)
    more: dict[str, Any] = {"showlegend": False, "hoverinfo": "skip", "width": 1.4}
    return [
        line(*np.vstack(group).T, name="edges", colour=_GREY, dash=dash, **more)
        for group, dash in ((seen, "solid"), (hidden, "dot"))
    ]


def _short_texts(value: Floats, interval: Floats, unit: Shown) -> list[str]:
    """Return values to two digits of half their 95 % interval; to four where there is none."""
    return [
        with_interval(float(one), float(low), float(high), unit)[0].text
        for one, (low, high) in zip(value, interval, strict=True)
    ]


def _cube_points(place: Floats, text: list[str], is_thin: Bools) -> list[Trace]:
    traces: list[Trace] = []
    for own, looks in ((~is_thin, "circle"), (is_thin, "circle-open")):
        traces.append(
            {
                "type": "scatter", "mode": "markers+text", "showlegend": False,
                "name": "runs say little" if looks == "circle-open" else "runs say much",
                "x": plain_numbers(place[own, 0]), "y": plain_numbers(place[own, 1]),
                "text": [one for one, is_own in zip(text, own, strict=True) if is_own],
                "textposition": "top center", "textfont": {"size": 11}, "hoverinfo": "text",
                "marker": {"size": 8, "color": COLOURS[0], "symbol": looks},
            }
        )  # fmt: skip
    return traces


def _away(view: ExperimentView, place: int) -> dict[str, Any]:
    """Return the name of the factor that leads away, at the lower right edge."""
    return {
        "x": 1 + _DEPTH[0] * 0.75, "y": _DEPTH[1] * 0.5, "xanchor": "left", "yanchor": "top",
        "text": plot_text(view.factor_label(place), 60).replace(" [", "<br>["), "showarrow": False,
        "align": "left", "font": {"size": 11},
    }  # fmt: skip
