"""Response surfaces, cubes, checks of a fit, screening effects.

References
----------
.. [1] CG-D-39-80, sec. 4.4.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
from scipy.special import ndtri, stdtrit

from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.screening import alias_matrix, half_normal_coordinates
from reduction.experiments.surface_points import ABOVE_LEVERAGE, evaluate_surfaces
from reduction.quantities.names import RESPONSES
from reduction.record.measurement import Bools, Floats, Integers
from reduction.report.figure_data import (
    Figure,
    Trace,
    axis,
    line,
    make_figure,
    named_axis,
    plain_numbers,
)
from reduction.report.product_views import ExperimentView, in_words, response_unit
from reduction.report.surface_grid import HELD, Planes, leverage_ratio, runs_on_plane
from reduction.report.text_style import (
    COLOURS,
    Shown,
    faded,
    number_text,
    plot_text,
    with_interval,
    with_prefix,
)

_SCALE = [[0.0, "#e4eef6"], [0.5, "#97c4e3"], [1.0, "#3a8fc8"]]
"""Light enough everywhere for dark labels upon it."""

_INK, _GREY = "#1b1f23", "#8C8C8C"

_DIGITS = 4


def base_response(name: str) -> str:
    """Return the response that a surface is of, before any transform.

    Examples
    --------
    >>> base_response("log_hysteresis_energy")
    'hysteresis_energy'
    """
    return next(base for base in RESPONSES if name.endswith(base))


def draw_surface(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Figure]:
    """Draw the surface over two factors, the third in the middle, and the runs made there."""
    name = surfaces.response_names[index]
    unit = response_unit(base_response(name), view.units)
    words = in_words(base_response(name))
    x, y = (_shown(view, place, planes.coded) for place in planes.across)
    middle = planes.value[index, 1] * unit.factor
    data: list[Trace] = [
        {
            "type": "surface", "name": "surface", "x": plain_numbers(x), "y": plain_numbers(y),
            "z": [plain_numbers(row, _DIGITS) for row in middle], "colorscale": _SCALE,
            "showscale": False, "showlegend": False, "opacity": 0.92,
            "contours": {"z": {"show": True, "color": faded("#000000", 0.25)}},
        }
    ]  # fmt: skip
    data += _points_in_space(view, surfaces, index, planes)
    held, level = view.factors[planes.held], view.levels(planes.held)[1]
    title = f"{view.name}: {words} at {_at(view, planes.held, level)}"
    return _given(
        make_figure(
            f"{view.key}-{name}-surface", title,
            f"Surface of the {words} over {in_words(view.factors[planes.across[0]])} and"
            f" {in_words(view.factors[planes.across[1]])}, {in_words(held)} held in the middle of"
            f" its range{_scale_words(name)}. Points: the runs made at this {in_words(held)}, lines"
            " their distance from the surface. Turn it with the pointer; the same values"
            " stand in the contours, whose SVG is lines throughout.",
            data, synthetic=view.is_synthetic, height=430,
            scene={
                "xaxis": axis(view.factor_label(planes.across[0])),
                "yaxis": axis(view.factor_label(planes.across[1])),
                "zaxis": axis(unit.label(words).replace(" ", "<br>", 1)),
                "camera": {
                    "eye": {"x": -1.4, "y": -1.58, "z": 0.8},
                    "center": {"x": 0, "y": 0, "z": -0.15},
                },
                "aspectmode": "cube",
            },
        )
    )  # fmt: skip


def draw_contours(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Figure]:
    """Draw contours at the low, middle and high level of the held factor, one scale for all."""
    name = surfaces.response_names[index]
    unit = response_unit(base_response(name), view.units)
    words = in_words(base_response(name))
    x, y = (_shown(view, place, planes.coded) for place in planes.across)
    value = planes.value[index] * unit.factor
    if not np.isfinite(value).any():
        return []
    ends = {"zmin": float(np.nanmin(value)), "zmax": float(np.nanmax(value))}
    found = []
    for place, level in enumerate(HELD):
        ratio = planes.leverage_ratio[index, place]
        data: list[Trace] = [
            {
                "type": "contour", "name": words, "showlegend": False, **ends,
                "x": plain_numbers(x), "y": plain_numbers(y),
                "z": [plain_numbers(row, _DIGITS) for row in value[place]],
                "colorscale": _SCALE, "line": {"color": _INK, "width": 0.8},
                "contours": {"coloring": "fill", "showlabels": True,
                             "labelfont": {"color": _INK, "size": 10}},
                "colorbar": {
                    "title": {"text": unit.unit}, "thickness": 10, "tickfont": {"size": 10},
                    "exponentformat": "none", "separatethousands": True,
                },
            }
        ]  # fmt: skip
        is_thin = bool((ratio > ABOVE_LEVERAGE).any())
        if is_thin:
            data.append(_thin_region(x, y, ratio))
        on_plane = runs_on_plane(view, planes, level)
        points, labels = _points_on_plane(view, planes, on_plane)
        data += points
        at = _at(view, planes.held, view.levels(planes.held)[place])
        says = (
            " Grey: the runs say less there than at the worst of them (leverage above the greatest"
            " of a run); a value there leans on the form of the surface."
            if is_thin
            else ""
        )
        found.append(
            make_figure(
                f"{view.key}-{name}-contour-{place}", f"{view.name}: {words} at {at}",
                f"Contours of the {words}{_scale_words(name)} at {at}. Points: the runs made there."
                f"{says}",
                data, synthetic=view.is_synthetic, height=380, annotations=labels,
                xaxis=axis(view.factor_label(planes.across[0])),
                yaxis=axis(view.factor_label(planes.across[1])),
            )
        )  # fmt: skip
    return found


def _shown(view: ExperimentView, place: int, coded: Floats) -> Floats:
    low, middle, high = view.levels(place)
    return middle + coded * (high - low) / 2


def _levels_reached(view: ExperimentView, place: int) -> Floats:
    return view.array("run_level")[:, place] * view.factor_units[place].factor


def _at(view: ExperimentView, place: int, level: float) -> str:
    return f"{number_text(level, 3)} {view.factor_units[place].unit}"


def _scale_words(name: str) -> str:
    """Say on what scale a surface was fitted where it was not the response itself."""
    if name == base_response(name):
        return ""
    scale = "logarithm" if name.startswith("log_") else "Box-Cox transform"
    return f", fitted to its {scale} and brought back (medians)"


def _given(figure: Figure) -> list[Figure]:
    return [figure] if figure.has_data else []


def _points_in_space(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: Planes
) -> list[Trace]:
    """Return the runs of the middle plane, and a line from each to the surface there."""
    name = base_response(surfaces.response_names[index])
    factor = response_unit(name, view.units).factor
    measured = view.per_run(f"{name}_measured")
    own = runs_on_plane(view, planes, 0.0) & np.isfinite(measured)
    if not own.any():
        return []
    x, y = (_levels_reached(view, place)[own] for place in planes.across)
    at = evaluate_surfaces(
        surfaces, view.array("run_coded_level")[own], units="coded", outside="flag"
    )
    z, foot = measured[own] * factor, at.value[index] * factor
    gap = np.full(z.size, np.nan)
    stems = {
        key: plain_numbers(np.stack(values, axis=1).ravel())
        for key, values in (("x", (x, x, gap)), ("y", (y, y, gap)), ("z", (z, foot, gap)))
    }
    return [
        {
            "type": "scatter3d", "mode": "lines", "name": "distance", "showlegend": False,
            "line": {"color": COLOURS[1], "width": 4}, "hoverinfo": "skip", **stems,
        },
        {
            "type": "scatter3d", "mode": "markers", "name": "runs", "showlegend": False,
            "x": plain_numbers(x), "y": plain_numbers(y), "z": plain_numbers(z),
            "text": [plot_text(run) for run, one in zip(view.runs, own, strict=True) if one],
            "marker": {"size": 4.5, "color": COLOURS[1]},
        },
    ]  # fmt: skip


def _points_on_plane(
    view: ExperimentView, planes: Planes, own: Bools
) -> tuple[list[Trace], list[Trace]]:
    """Return the runs of a plane at the levels they reached, and their labels; repeats have one."""
    if not own.any():
        return [], []
    cells = view.per_run("run_cell")
    x, y = (_levels_reached(view, place) for place in planes.across)
    middle = np.mean(view.levels(planes.across[0]))
    places = np.flatnonzero(own)
    labels: list[Trace] = []
    for k in places:
        mates = [j for j in places if cells[j] == cells[k] and cells[k] > 0] or [k]
        if mates[0] != k:
            continue
        # a veil behind it, or the numbers of the contours run through it
        is_left = bool(x[k] < middle)
        labels.append(
            {
                "text": plot_text(", ".join(view.runs[j] for j in mates)), "showarrow": False,
                "x": plain_numbers(x[k : k + 1])[0], "y": plain_numbers(y[k : k + 1])[0],
                "xanchor": "left" if is_left else "right", "xshift": 8 if is_left else -8,
                "font": {"size": 10, "color": _INK}, "bgcolor": "rgba(255,255,255,0.8)",
                "borderpad": 1,
            }
        )  # fmt: skip
    points: Trace = {
        "type": "scatter", "mode": "markers", "name": "runs", "showlegend": False,
        "x": plain_numbers(x[own]), "y": plain_numbers(y[own]), "cliponaxis": False,
        "text": [plot_text(view.runs[k]) for k in places],
        "marker": {"size": 9, "color": COLOURS[1], "line": {"width": 1.5, "color": "#ffffff"}},
    }  # fmt: skip
    return [points], labels


def _thin_region(x: Floats, y: Floats, ratio: Floats) -> Trace:
    """Return a grey veil with a dashed edge where the leverage is above that of every run."""
    return {
        "type": "contour", "name": "runs say little", "showlegend": False, "showscale": False,
        "x": plain_numbers(x), "y": plain_numbers(y),
        "z": [plain_numbers(row, 3) for row in ratio], "hoverinfo": "skip",
        "contours": {"type": "constraint", "operation": "<", "value": ABOVE_LEVERAGE},
        "fillcolor": faded("#555555", 0.38), "line": {"color": _INK, "width": 1.5, "dash": "dash"},
    }  # fmt: skip


_CUBE_GREY = "#8C8C8C"

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
            f"Value of the surface of the {words}{_scale_words(name)} at corners, edges and centre"
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
        line(*np.vstack(group).T, name="edges", colour=_CUBE_GREY, dash=dash, **more)
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


CONFIDENCE = 0.95

_CHECK_GREY = "#8C8C8C"


def term_words(powers: Integers, factors: tuple[str, ...]) -> str:
    """Return a term as a reader says it.

    Examples
    --------
    >>> term_words(np.array([1, 1]), ("frequency", "mean_tension"))
    'frequency by mean tension'
    >>> term_words(np.array([2, 0]), ("frequency", "mean_tension"))
    'frequency²'
    """
    parts = [
        in_words(name) + ("²" if power == 2 else "")
        for name, power in zip(factors, powers, strict=True)
        if power
    ]
    return " by ".join(parts) or "mean"


def draw_pareto(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> list[Figure]:
    """Draw each term over its scatter, the largest on top, and the least that counts."""
    name = surfaces.response_names[index]
    size = np.abs(surfaces.t[index])
    chosen = np.flatnonzero(np.isfinite(size) & (surfaces.exponents.sum(axis=1) > 0))
    if chosen.size == 0:
        return []
    chosen = chosen[np.argsort(size[chosen], kind="stable")]
    freedom = surfaces.term_degrees_of_freedom[index, chosen]
    critical = np.asarray(stdtrit(freedom, (1 + CONFIDENCE) / 2))
    counts = size[chosen] > critical
    height = np.arange(chosen.size, dtype=np.float64)
    data: list[Trace] = [
        {
            "type": "bar", "orientation": "h", "name": words, "width": 0.7,
            "x": plain_numbers(size[chosen][own], 4), "y": plain_numbers(height[own]),
            "marker": {"color": tint},
        }
        for own, tint, words in (
            (counts, COLOURS[0], "differs from zero"),
            (~counts, _CHECK_GREY, "not told from zero"),
        )
        if own.any()
    ]  # fmt: skip
    # a term with an error term of its own has a line of its own
    ends = np.stack([height - 0.5, height + 0.5, np.full(height.size, np.nan)], axis=1)
    data.append(
        line(
            np.repeat(critical, 3), ends.ravel(), name=f"least |t| at {100 * CONFIDENCE:g} %",
            colour=COLOURS[1], dash="dash", width=2.2,
        )
    )  # fmt: skip
    is_wide = bool(size[chosen].max() > _WIDE * critical.min())
    labels = [
        f"{term_words(surfaces.exponents[k], view.factors)} {surfaces.labels[k]}".replace(
            " by ", "\nby "
        )
        for k in chosen
    ]
    scale = {"type": "log"} if is_wide else {"rangemode": "tozero"}
    return [
        make_figure(
            f"{view.key}-{name}-pareto", f"{view.name}: terms of {in_words(name)} by size",
            "Each coefficient of the coded factors over its standard uncertainty, |t|. Beyond the"
            f" dashed line a term differs from zero at {100 * CONFIDENCE:g} %, judged alone"
            f"{'; the axis is logarithmic' if is_wide else ''}.",
            data, synthetic=view.is_synthetic, height=120 + 34 * len(labels), barmode="overlay",
            xaxis=axis("|t| [1]", **scale),
            yaxis=named_axis("term [B]", labels),
        )
    ]  # fmt: skip


_WIDE = 50.0
"""Largest over critical |t| from which small terms need a logarithmic axis to be seen."""


def draw_checks(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, order: Mapping[str, int]
) -> list[Figure]:
    """Draw predicted against actual, residuals in the order of the runs, and on normal scores."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    residual = surfaces.residual[index] * unit.factor
    known = np.isfinite(residual)
    if not known.any():
        return []
    figures = (
        _predicted(view, surfaces, index, unit, known),
        _in_order(view, name, residual, unit, order),
        _normal(view, surfaces, index),
    )
    return [figure for figure in figures if figure.has_data]


def _predicted(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, unit: Shown, known: Bools
) -> Figure:
    name = surfaces.response_names[index]
    fitted = surfaces.fitted[index][known] * unit.factor
    residual = surfaces.residual[index][known] * unit.factor
    actual = fitted + residual
    ends = np.array([min(actual.min(), fitted.min()), max(actual.max(), fitted.max())])
    names = [run for run, one in zip(view.runs, known, strict=True) if one]
    points = _points(actual, fitted, names)
    points["customdata"] = plain_numbers(residual, 4)
    points["hovertemplate"] = (
        "%{text}<br>measured %{x:.4~g}<br>surface %{y:.4~g}<br>residual %{customdata:.3~g}"
        "<extra></extra>"
    )
    data = [
        line(ends, ends, name="equal", colour=_CHECK_GREY, dash="dot", showlegend=False),
        points,
    ]
    return make_figure(
        f"{view.key}-{name}-predicted", f"{view.name}: {in_words(name)} against measured",
        "Value of the surface against the measured one, a point a run; dotted: equal. The pointer"
        " shows the residual.",
        data, synthetic=view.is_synthetic,
        xaxis=axis(unit.label("measured")), yaxis=axis(unit.label("by the surface")),
    )  # fmt: skip


def _in_order(
    view: ExperimentView, name: str, residual: Floats, unit: Shown, order: Mapping[str, int]
) -> Figure:
    runs = view.texts("run_name")
    is_known = all(run in order for run in runs)
    place = np.array([order[run] if is_known else k + 1 for k, run in enumerate(runs)], float)
    sequence = np.argsort(place, kind="stable")
    data = [
        line(
            place[sequence], residual[sequence], name="in order", colour=COLOURS[0], width=0.8,
            showlegend=False, hoverinfo="skip",
        ),
        _points(place, residual, list(view.runs)),
    ]  # fmt: skip
    return make_figure(
        f"{view.key}-{name}-order", f"{view.name}: {in_words(name)}, residuals in order",
        "Measured less surface, in the order"
        f" {'the tests were made' if is_known else 'of the plan'}: a trend would be wear, heating"
        " or bedding-in that no factor of the surface holds.",
        data, synthetic=view.is_synthetic,
        xaxis=axis("order of the run [1]"), yaxis=axis(unit.label("residual"), zeroline=True),
    )  # fmt: skip


def _normal(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> Figure:
    name = surfaces.response_names[index]
    inner = surfaces.diagnostics.studentized_residual[index]
    known = np.flatnonzero(np.isfinite(inner))
    own = known[np.argsort(inner[known], kind="stable")]
    # Blom's places, as in the straightness that is given beside them
    score = ndtri((np.arange(1, own.size + 1) - 0.375) / (own.size + 0.25))
    straight = surfaces.diagnostics.probability_plot_correlation[index]
    ends = np.array([-2.0, 2.0])
    data = [
        line(ends, ends, name="normal", colour=_CHECK_GREY, dash="dot", showlegend=False),
        _points(score, inner[own], [view.runs[k] for k in own]),
    ]
    return make_figure(
        f"{view.key}-{name}-normal", f"{view.name}: {in_words(name)}, normal plot",
        "Residuals over their own standard deviations, against the scores of a normal sample;"
        f" dotted: as of one. Squared correlation {straight:.3f}. With few degrees of freedom such"
        " a plot shows one run far off, and little of a distribution.",
        data, synthetic=view.is_synthetic,
        xaxis=axis("normal score [1]"), yaxis=axis("studentized residual [1]"),
    )  # fmt: skip


def _points(x: Floats, y: Floats, names: list[str]) -> Trace:
    return {
        "type": "scatter", "mode": "markers", "name": "runs", "showlegend": False,
        "x": plain_numbers(x), "y": plain_numbers(y), "text": [plot_text(one) for one in names],
        "marker": {"size": 8, "color": COLOURS[0]},
    }  # fmt: skip


_SCREENING_GREY = "#8C8C8C"

_LEAST_ALIAS = 1e-6

_FULL = 1 - 1e-6

_OF_DUMMIES, _OF_FACTORS, _SEEN = _SCREENING_GREY, COLOURS[5], COLOURS[0]


def draw_effects(view: ExperimentView, name: str) -> list[Figure]:
    """Draw the effects by size with the least that counts, and their half-normal plot."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0 or not np.isfinite(effect).any():
        return []
    unit = response_unit(name, view.units)
    size = np.abs(effect) * unit.factor
    kinds = _kinds(view, name)
    labels = [in_words(column) for column in view.texts("plan_column_name")]
    return [_bars(view, name, size, kinds, labels), _half_normal(view, name, size, kinds, labels)]


def confounding_words(view: ExperimentView) -> list[str]:
    """Say what stands in each main effect beside the factor itself."""
    plan = view.array("run_plan")[:, : len(view.factors)]
    _, alias = alias_matrix(np.where(plan < 0, -1.0, 1.0))
    of_factors = np.abs(alias[1:])
    present = of_factors > _LEAST_ALIAS
    if not present.any():
        return ["No interaction of two factors stands in a main effect: the columns are clear."]
    largest = float(of_factors.max())
    whole = "the whole of" if largest > _FULL else f"up to {largest:.2g} of"
    numbers = sorted({int(number) for number in present.sum(axis=1)})
    many = " to ".join(map(str, dict.fromkeys([numbers[0], numbers[-1]])))
    return [
        f"Confounding: each main effect holds {whole} {many} interactions of two other factors,"
        " plus or minus. A"
        " factor that looks active may be a sum of interactions, and one that looks idle may be"
        " hidden by them: what comes out here is for a second experiment to confirm."
    ]


def _bars(
    view: ExperimentView, name: str, size: Floats, kinds: list[str], labels: list[str]
) -> Figure:
    unit = response_unit(name, view.units)
    order = np.argsort(size, kind="stable")
    data: list[Trace] = []
    for kind, tint in _TINTS.items():
        own = [height for height, k in enumerate(order) if kinds[k] == kind]
        if own:
            data.append(
                {
                    "type": "bar", "orientation": "h", "name": kind, "width": 0.7,
                    "x": plain_numbers(size[order[own]]), "y": own,
                    "marker": {"color": tint},
                }
            )  # fmt: skip
    level = 100 * (1 - view.scalar("effect_significance"))
    ends = np.array([-0.5, order.size - 0.5])
    for what, dash, tint, words in (
        ("minimum_significant_effect", "dash", COLOURS[1], f"least at {level:g} %"),
        ("simultaneous_minimum_effect", "dot", COLOURS[3], "least, all factors together"),
    ):
        least = view.scalar(f"{name}_{what}") * unit.factor
        if np.isfinite(least):
            data.append(
                line(np.full(2, least), ends, name=words, colour=tint, dash=dash, width=2.2)
            )
    return make_figure(
        f"{view.key}-{name}-effects", f"{view.name}: effects on {in_words(name)} by size",
        "Size of each effect. Dashed: the least that counts, for a factor judged alone; dotted: for"
        " all of them at once. Dummies are columns that no factor uses, and show the scatter.",
        data, synthetic=view.is_synthetic, height=400,
        xaxis=axis(unit.label("size of the effect"), rangemode="tozero"),
        yaxis=named_axis("column of the plan [1]", [labels[k] for k in order]),
        barmode="overlay",
    )  # fmt: skip


def _half_normal(
    view: ExperimentView, name: str, size: Floats, kinds: list[str], labels: list[str]
) -> Figure:
    unit = response_unit(name, view.units)
    points = half_normal_coordinates(size)
    spread = view.scalar(f"{name}_effect_standard_uncertainty") * unit.factor
    reach = np.array([0.0, float(points.quantile[-1])])
    data: list[Trace] = [
        line(reach, reach * spread, name="scatter alone", colour=_SCREENING_GREY, dash="dot")
    ]
    for kind, tint in _TINTS.items():
        own = [k for k in range(size.size) if kinds[points.order[k]] == kind]
        if own:
            is_named = kind == "significant"
            data.append(
                {
                    "type": "scatter", "mode": "markers+text" if is_named else "markers",
                    "name": kind, "x": plain_numbers(points.quantile[own]),
                    "y": plain_numbers(points.size[own]),
                    "text": [plot_text(labels[points.order[k]]) for k in own],
                    "textposition": "middle left", "textfont": {"size": 10},
                    "marker": {"size": 9, "color": tint, "symbol": _MARKS[kind]},
                }
            )  # fmt: skip
    return make_figure(
        f"{view.key}-{name}-half-normal", f"{view.name}: {in_words(name)}, half-normal plot",
        "Size of each effect against the half-normal quantile of its place. Scatter alone lies on"
        " the dotted line from zero; a factor that acts lies above it, at the right.",
        data, synthetic=view.is_synthetic, height=400,
        xaxis=axis("half-normal quantile [1]"), yaxis=axis(unit.label("size of the effect")),
    )  # fmt: skip


_TINTS = {"significant": _SEEN, "not significant": _OF_FACTORS, "dummy": _OF_DUMMIES}

_MARKS = {"significant": "circle", "not significant": "circle-open", "dummy": "x"}


def _kinds(view: ExperimentView, name: str) -> list[str]:
    counts = view.array(f"{name}_effect_is_significant")
    return [
        "dummy" if k >= len(view.factors) else "significant" if counts[k] > 0 else "not significant"
        for k in range(counts.size)
    ]
