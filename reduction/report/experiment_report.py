"""Tables and figures of experiments and their surfaces.

References
----------
.. [1] CG-D-39-80, sec. 4.4.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 7.2.7 (what a report of uncertainty holds).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.shared_errors import FREEDOM
from reduction.archive.uncertainty_budget import all_budgets
from reduction.experiments.fit_results import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.experiments.screening import alias_matrix
from reduction.experiments.surface_points import (
    ABOVE_LEVERAGE,
    SurfaceValues,
    evaluate_surfaces,
    extremes_in_box,
    greatest_leverage,
)
from reduction.quantities.names import QUANTITIES, RESPONSES, SCALES
from reduction.record.contributions import CONFIDENCE, coverage_factor, effective_degrees_of_freedom
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import urgency
from reduction.report.answer_tables import AnswerBudget
from reduction.report.campaign_summary import SummaryFinding
from reduction.report.figure_data import (
    Figure,
    Trace,
    axis,
    line,
    make_figure,
    named_axis,
    plain_numbers,
)
from reduction.report.product_views import FORM_WORDS, ExperimentView, in_words, response_unit
from reduction.report.sheet import Sheet
from reduction.report.test_section import CONDITIONING, REFUSED, about_line, add_line
from reduction.report.test_view import (
    Expanded,
    TestView,
    expand,
    expanded_of,
    factor_words,
    plus_minus,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    COLOURS,
    NOT_GIVEN,
    PERCENT,
    SYMBOLS,
    PageTable,
    Shown,
    TableCell,
    colour,
    faded,
    in_order,
    make_table,
    number,
    number_text,
    plot_text,
    share_text,
    shown,
    source_meanings,
    source_words,
    superscript,
    with_interval,
    words,
)
from reduction.uncertainty.budget import RANDOM, Budget, BudgetRow
from reduction.uncertainty.surface_errors import with_shared_at_points

POINTS = 31

"""Points along each side of a plane: more would not be visible, and would enlarge the page."""

HELD = (-1.0, 0.0, 1.0)

"""Coded levels of the held factor, one plane each. [1]"""


_NEAR = 0.5

"""A run belongs to the plane that is nearest to the level of its held factor. [1]"""


@dataclass(frozen=True)
class _Planes:
    """Every surface of an experiment on three planes."""

    across: tuple[int, int]
    held: int
    coded: Floats
    value: Floats
    leverage_ratio: Floats


def make_planes(view: ExperimentView, surfaces: ResponseSurfaces) -> _Planes | None:
    """Return the planes over two loads at three frequencies; None with fewer than three factors."""
    names = view.factors
    if len(names) < 3:
        return None
    held = names.index("frequency") if "frequency" in names else len(names) - 1
    across = [place for place in range(len(names)) if place != held][:2]
    side = np.linspace(-1.0, 1.0, POINTS)
    points = np.zeros((3, POINTS, POINTS, len(names)))
    points[..., held] = np.array(HELD)[:, None, None]
    points[..., across[0]] = side
    points[..., across[1]] = side[:, None]
    at = evaluate_surfaces(surfaces, points.reshape(-1, len(names)), units="coded", outside="flag")
    shape = (len(surfaces.response_names), *points.shape[:3])
    ratio = _leverage_ratio(view, surfaces, at)
    return _Planes(
        (across[0], across[1]), held, side, at.value.reshape(shape), ratio.reshape(shape)
    )


def _leverage_ratio(view: ExperimentView, surfaces: ResponseSurfaces, at: SurfaceValues) -> Floats:
    """Leverage of points over the greatest leverage of a tested level, (n_responses, n_points)."""
    plan = view.array("run_plan")[:, : len(view.factors)]
    ratio: Floats = at.variance_factor / greatest_leverage(surfaces, plan)[:, None]
    return ratio


def _runs_on_plane(view: ExperimentView, planes: _Planes, level: float) -> Bools:
    """Whether each run was made on a plane."""
    coded = view.array("run_coded_level")
    others = [k for k in range(coded.shape[1]) if k not in (*planes.across, planes.held)]
    on_plane = np.abs(coded[:, planes.held] - level) < _NEAR
    return np.asarray(on_plane & (np.abs(coded[:, others]) < _NEAR).all(axis=1))


def negative_inside(surfaces: ResponseSurfaces) -> dict[str, tuple[float, Floats]]:
    """Return least value and its place of each surface that is negative although it cannot be."""
    least, _, place = extremes_in_box(surfaces)
    return {
        name: (float(least[index]), place[index])
        for index, name in enumerate(surfaces.response_names)
        if name in RESPONSES and least[index] < 0
    }


_CONTRIBUTION = "_uncertainty_contribution"


@dataclass(frozen=True)
class _CoefficientSpread:
    """Expanded uncertainty of the coefficients of a surface, and its shared part alone."""

    all: Expanded
    shared: Floats


def _expanded_of_coefficients(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, *, in_units: bool = False
) -> _CoefficientSpread:
    """Return the uncertainty of the coefficients of a surface, coded or in units."""
    name = f"{surfaces.response_names[index]}_coefficient"
    random = surfaces.coefficient_standard_uncertainty[index]
    if in_units:
        name += "_engineering"
        random = surfaces.coefficient_engineering_standard_uncertainty[index]
    contribution = _rows(view, name, random.size)
    factor = coverage_factor(
        effective_degrees_of_freedom(
            random,
            surfaces.term_degrees_of_freedom[index],
            contribution=contribution,
            of_contribution=_freedom(view),
        )
    )
    shared = np.sqrt(np.sum(contribution**2, axis=0))
    return _CoefficientSpread(Expanded(factor * np.hypot(random, shared), factor), factor * shared)


def _shared_by_runs(view: ExperimentView, surfaces: ResponseSurfaces) -> list[str]:
    """Return the shared sources of the runs that affect a surface, in fixed order."""
    sources = view.texts("uncertainty_source")
    found: set[str] = set()
    for name in surfaces.response_names:
        rows = _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        found |= {sources[place] for place in np.flatnonzero(np.nan_to_num(rows).any(axis=1))}
    return in_order(found)


def _interval_of_surfaces(
    view: ExperimentView, surfaces: ResponseSurfaces, coded: ArrayLike
) -> tuple[Floats, Floats]:
    """Return the ends of the 95 % interval of every surface at points in coded levels."""
    at = evaluate_surfaces(surfaces, coded, units="coded", outside="flag")
    rows = [
        _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        for name in surfaces.response_names
    ]
    both = with_shared_at_points(surfaces, at, np.stack(rows, axis=1), _freedom(view))
    ends = both.confidence_interval
    return np.array(ends[..., 0]), np.array(ends[..., 1])


def _expanded_of_runs(view: ExperimentView, name: str, tests: Mapping[str, TestView]) -> Expanded:
    """Return the expanded uncertainty of a response in each run."""
    spread = view.per_run(f"{name}_measured_standard_uncertainty")
    given = expand(spread)
    half, factor = given.half.copy(), given.factor.copy()
    pairs = zip(view.texts("run_name"), view.texts("run_specimen"), strict=True)
    for place, (run, specimen) in enumerate(pairs):
        test = tests.get(run)
        own = None if test is None else test.array(f"test_{name}")
        if test is None or own is None or specimen not in test.specimens:
            continue
        found = expanded_of(test, f"test_{name}", own)
        row = test.specimens.index(specimen)
        half[place], factor[place] = found.half[row], found.factor[row]
    return Expanded(half, factor)


def _rows(view: ExperimentView, name: str, n_terms: int) -> Floats:
    """Contributions to the coefficients, shape (n_components, n_terms): zero where none."""
    found = view.array(f"{name}{_CONTRIBUTION}")
    n_components = _freedom(view).size
    if found.ndim != 2:
        return np.zeros((n_components, n_terms))
    return np.asarray(found[:n_components, :n_terms])


def _freedom(view: ExperimentView) -> Floats:
    """Degrees of freedom of each shared error of the experiment."""
    sources = list(filter(None, view.texts("uncertainty_source")))
    known = view.array(FREEDOM)[: len(sources)]
    return np.where(known > 0, known, np.inf) if known.size else np.full(len(sources), np.inf)


_SCALE = [[0.0, "#e4eef6"], [0.5, "#97c4e3"], [1.0, "#3a8fc8"]]

"""Light enough everywhere for dark labels on it."""

_INK, _GREY = "#1b1f23", "#8C8C8C"

_DIGITS = 4


def _base_response(name: str) -> str:
    """Return the response of a surface, before any transform.

    Examples
    --------
    >>> _base_response("log_hysteresis_energy")
    'hysteresis_energy'
    """
    return next(base for base in RESPONSES if name.endswith(base))


def draw_surface(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: _Planes
) -> list[Figure]:
    """Draw the surface over two factors, the third in the middle, and the runs made there."""
    name = surfaces.response_names[index]
    unit = response_unit(_base_response(name), view.units)
    words = in_words(_base_response(name))
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
            f" its range{_scale_words(name)}. Points: the runs made at this {in_words(held)},"
            " lines their distance from the surface. Drag to rotate; the contour figure shows the"
            " same values.",
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
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: _Planes
) -> list[Figure]:
    """Draw contours at the low, middle and high level of the held factor, one scale for all."""
    name = surfaces.response_names[index]
    unit = response_unit(_base_response(name), view.units)
    words = in_words(_base_response(name))
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
        on_plane = _runs_on_plane(view, planes, level)
        points, labels = _points_on_plane(view, planes, on_plane)
        data += points
        at = _at(view, planes.held, view.levels(planes.held)[place])
        says = (
            " Grey: leverage above that of any run; values there depend on the form of the surface."
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
    """Describe the scale of a surface that was not fitted to the response itself."""
    if name == _base_response(name):
        return ""
    return f", fitted to the {in_words(name)} and transformed back (medians)"


def _given(figure: Figure) -> list[Figure]:
    return [figure] if figure.has_data else []


def _points_in_space(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: _Planes
) -> list[Trace]:
    """Return the runs of the middle plane, and a line from each to the surface there."""
    name = _base_response(surfaces.response_names[index])
    factor = response_unit(name, view.units).factor
    measured = view.per_run(f"{name}_measured")
    own = _runs_on_plane(view, planes, 0.0) & np.isfinite(measured)
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
    view: ExperimentView, planes: _Planes, own: Bools
) -> tuple[list[Trace], list[Trace]]:
    """Return the runs of a plane at the levels they reached, and their labels, one for repeats."""
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
        # a background patch, since otherwise the contour labels run through it
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
    """Return a grey patch with a dashed edge where the leverage exceeds that of every run."""
    return {
        "type": "contour", "name": "runs say little", "showlegend": False, "showscale": False,
        "x": plain_numbers(x), "y": plain_numbers(y),
        "z": [plain_numbers(row, 3) for row in ratio], "hoverinfo": "skip",
        "contours": {"type": "constraint", "operation": "<", "value": ABOVE_LEVERAGE},
        "fillcolor": faded("#555555", 0.38), "line": {"color": _INK, "width": 1.5, "dash": "dash"},
    }  # fmt: skip


_CHECK_GREY = "#8C8C8C"


def _term_words(powers: Integers, factors: tuple[str, ...]) -> str:
    """Return a term in words.

    Examples
    --------
    >>> _term_words(np.array([1, 1]), ("frequency", "mean_tension"))
    'frequency by mean tension'
    >>> _term_words(np.array([2, 0]), ("frequency", "mean_tension"))
    'frequency²'
    """
    parts = [
        in_words(name) + ("²" if power == 2 else "")
        for name, power in zip(factors, powers, strict=True)
        if power
    ]
    return " by ".join(parts) or "mean"


def draw_checks(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, order: Mapping[str, int]
) -> list[Figure]:
    """Draw predicted against actual, and residuals in the order of the runs."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    residual = surfaces.residual[index] * unit.factor
    known = np.isfinite(residual)
    if not known.any():
        return []
    figures = (
        _predicted(view, surfaces, index, unit, known),
        _in_order(view, name, residual, unit, order),
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
        "Surface value against measured value, one point per run; dotted: equal. Hover over a"
        " point for its residual.",
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
        "Measured minus surface, in the order"
        f" {'the tests were made' if is_known else 'of the plan'}: a trend indicates wear, heating"
        " or bedding-in that no factor accounts for.",
        data, synthetic=view.is_synthetic,
        xaxis=axis("order of the run [1]"), yaxis=axis(unit.label("residual"), zeroline=True),
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
    """Draw the effects by size with the significance limit."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0 or not np.isfinite(effect).any():
        return []
    unit = response_unit(name, view.units)
    size = np.abs(effect) * unit.factor
    kinds = _kinds(view, name)
    labels = [in_words(column) for column in view.texts("plan_column_name")]
    return [_bars(view, name, size, kinds, labels)]


def confounding_words(view: ExperimentView) -> list[str]:
    """Name the effects that are confounded with each main effect."""
    plan = view.array("run_plan")[:, : len(view.factors)]
    _, alias = alias_matrix(np.where(plan < 0, -1.0, 1.0))
    of_factors = np.abs(alias[1:])
    present = of_factors > _LEAST_ALIAS
    if not present.any():
        return ["No two-factor interaction is aliased with a main effect."]
    largest = float(of_factors.max())
    whole = "the whole of" if largest > _FULL else f"up to {largest:.2g} of"
    numbers = sorted({int(number) for number in present.sum(axis=1)})
    many = " to ".join(map(str, dict.fromkeys([numbers[0], numbers[-1]])))
    return [
        f"Confounding: each main effect is aliased with {whole} {many} interactions of two other"
        " factors, with either sign. A factor that looks active may be a sum of interactions, and"
        " one that looks inactive may be hidden by them. Confirm the result by a second experiment."
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
    for what, dash, tint, label in (
        ("minimum_significant_effect", "dash", COLOURS[1], f"least at {level:g} %"),
        ("simultaneous_minimum_effect", "dot", COLOURS[3], "least, all factors together"),
    ):
        least = view.scalar(f"{name}_{what}") * unit.factor
        if np.isfinite(least):
            data.append(
                line(np.full(2, least), ends, name=label, colour=tint, dash=dash, width=2.2)
            )
    return make_figure(
        f"{view.key}-{name}-effects", f"{view.name}: effects on {in_words(name)} by size",
        "Size of each effect. Dashed: significance limit for one factor judged alone; dotted: for"
        " all factors together. Dummies are columns without a factor; they show the scatter.",
        data, synthetic=view.is_synthetic, height=400,
        xaxis=axis(unit.label("size of the effect"), rangemode="tozero"),
        yaxis=named_axis("column of the plan [1]", [labels[k] for k in order]),
        barmode="overlay",
    )  # fmt: skip


_TINTS = {"significant": _SEEN, "not significant": _OF_FACTORS, "dummy": _OF_DUMMIES}


def _kinds(view: ExperimentView, name: str) -> list[str]:
    counts = view.array(f"{name}_effect_is_significant")
    return [
        "dummy" if k >= len(view.factors) else "significant" if counts[k] > 0 else "not significant"
        for k in range(counts.size)
    ]


_PRINTED = (
    "F as printed in CG-D-39-80 counts the mean among the terms and in the error (10 and 4 degrees"
    " of freedom for fifteen runs); it is given only for comparison with the report."
)

_OF_RUNS = "scatter of the runs about the surface"

_ONE_LINE = "differences between lines (one was tested)"

NOT_OF_RUNS = "errors common to all runs: calibration, gauge length, the one line tested"

"""Errors that no scatter of runs includes."""

_LARGE = 1e9

"""From this value on, all rows of a column of squares have powers of ten."""

_ON_SCALE = {
    "log": ", by its logarithm",
    "box-cox": ", by its Box-Cox transform",
    "log-times-frequency": ", by the logarithm of its product with frequency",
}


def run_table(
    view: ExperimentView, tests: Mapping[str, TestView] | None = None
) -> PageTable | None:
    """Return the runs as planned and as reached, with the responses of each."""
    own = {} if tests is None else tests
    strength = view.per_run("run_rated_break_strength")
    is_share = bool(np.isfinite(strength).any())
    load = Shown("%RBS", 100.0) if is_share else shown("tension", view.units)
    divisor = strength if is_share else np.ones(len(view.runs))
    level, plan = view.array("run_level"), view.array("run_plan")[:, : len(view.factors)]
    sheet = Sheet(view, ("run",)).texts("run", view.runs).texts("plan, coded", map(_coded, plan))
    for place, unit in enumerate(view.factor_units):
        sheet.numbers(in_words(view.factors[place]), level[:, place], unit)
    for heading, name in (("peak", "run_peak_tension"), ("minimum", "run_minimum_tension")):
        pairs = zip(view.per_run(name), load.factor / divisor, strict=True)
        sheet.cells(load.label(heading), [_fixed(*one, 1 if is_share else 0) for one in pairs])
    for name in view.responses:
        sheet.measured(
            in_words(name), view.per_run(f"{name}_measured"), response_unit(name, view.units),
            _expanded_of_runs(view, name, own), is_short=True,
        )  # fmt: skip
    if any(view.texts("run_remark")):
        sheet.texts("remark", "run_remark")
    factors = ", ".join(in_words(name) for name in view.factors)
    return sheet.table(
        f"Runs as planned (coded {factors}) and as reached: means over the cycles of each run; peak"
        " and minimum are the greatest and least of its cycles.",
        remarks=[_about_runs(view, sheet, own)], is_compact=True,
    )  # fmt: skip


def _about_runs(view: ExperimentView, sheet: Sheet, tests: Mapping[str, TestView]) -> str:
    runs = [tests[name] for name in dict.fromkeys(view.texts("run_name")) if name in tests]
    held = "scatter between the cycles of the run"
    if runs:
        names = [f"test_{name}" for name in view.responses]
        return plus_minus_of_tests(sheet.factors, runs, names, found_from=held)
    has_line = {"dissipation_spring_constant", "relaxation_time"} & set(view.responses)
    return plus_minus(sheet.factors, held + (", and the K_0 of the slow pull" if has_line else ""))


def _fixed(value: float, factor: float, places: int) -> TableCell:
    """Return a cell with a number to so many places; it also keeps the value of the archive."""
    if not np.isfinite(value * factor):
        return TableCell(NOT_GIVEN, is_number=True)
    text = f"{round(value * factor, places) + 0.0:,.{places}f}"
    return TableCell(text, repr(float(value)), is_number=True)


def _coded(levels: Floats) -> str:
    return ", ".join("0" if level == 0 else f"{level:+g}" for level in levels)


def caution_table(view: ExperimentView) -> PageTable | None:
    """Return the warnings about the runs as reached."""
    own = view.own_rows("caution")
    return (
        Sheet(view)
        .texts("kind", [row["caution_kind"].replace("-", " ") for row in own])
        .texts("runs", [row.get("caution_runs", "") or "all runs" for row in own])
        .texts("caution", [row["caution"] for row in own])
        .texts("remedy", [row.get("caution_hint", "") for row in own])
        .table("Cautions about the runs as they were made.")
    )  # fmt: skip


def effect_table(view: ExperimentView, name: str) -> PageTable | None:
    """Return the effects of a screening on one response, the largest first."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0:
        return None
    # without dummies the error is Lenth's, with a third as many degrees of freedom as effects
    freedom = effect.size - len(view.factors) or effect.size / 3
    spread = expand(view.scalar(f"{name}_effect_standard_uncertainty"), degrees_of_freedom=freedom)
    order = np.argsort(-np.abs(effect), kind="stable")
    counts = np.where(view.array(f"{name}_effect_is_significant") > 0, "yes", "no")
    is_factor = np.arange(effect.size) < len(view.factors)
    sheet = Sheet(view)
    (
        sheet.texts("factor", [in_words(view.texts("plan_column_name")[k]) for k in order])
        .measured("effect", effect[order], response_unit(name, view.units), spread)
        .numbers("share of the mean", effect[order] / view.scalar(f"{name}_mean"), PERCENT, 3)
        .numbers("t", view.array(f"{name}_effect_t")[order], "number")
        .probabilities("p", view.array(f"{name}_effect_p_value")[order])
        .texts("significant", np.where(is_factor, counts, "")[order])
    )
    return sheet.table(
        f"{in_words(name).capitalize()}: effects (mean at the high level minus mean at the low"
        " level).",
        remarks=[
            "A dummy is a column without a factor: it shows scatter and interactions.",
            plus_minus(sheet.factors, "effects of the dummies", left_out=NOT_OF_RUNS),
        ],
    )  # fmt: skip


def answer_table(view: ExperimentView, surfaces: ResponseSurfaces) -> PageTable | None:
    """Return each response in the middle of the tested range, and its range over it."""
    least, greatest, _ = extremes_in_box(surfaces)
    centre = np.zeros((1, len(view.factors)))
    middle = evaluate_surfaces(surfaces, centre, units="coded")
    lows, highs = _interval_of_surfaces(view, surfaces, centre)
    names = surfaces.response_names
    # of several surfaces of a response, the one used for look-ups
    used = {
        next(f"{scale}{base}" for scale in (*SCALES, "") if f"{scale}{base}" in names)
        for base in map(_base_response, names)
    }
    kept = [
        (k, _base_response(name), response_unit(_base_response(name), view.units))
        for k, name in enumerate(names)
        if np.isfinite(middle.value[k, 0]) and name in used
    ]
    cells = [
        with_interval(
            float(middle.value[k, 0]), float(lows[k, 0]), float(highs[k, 0]), unit
        )
        for k, _, unit in kept
    ]  # fmt: skip
    middles = ", ".join(
        f"{in_words(name)} {number_text(view.levels(place)[1], 3)} {view.factor_units[place].unit}"
        for place, name in enumerate(view.factors)
    )
    sources = _shared_by_runs(view, surfaces)
    return (
        Sheet(view)
        .texts(
            "response",
            [
                unit.label(f"{in_words(base)}{_ON_SCALE.get(surfaces.transform[k], '')}")
                for k, base, unit in kept
            ],
        )
        .cells("at the centre", [shown_ for shown_, _ in cells])
        .cells(f"{100 * CONFIDENCE:g} % interval", [ends for _, ends in cells])
        .cells("minimum", [number(float(least[k]), unit) for k, _, unit in kept])
        .cells("maximum", [number(float(greatest[k]), unit) for k, _, unit in kept])
        .table(
            f"Experiment {view.name}: responses from the fitted surfaces, at the centre of the"
            f" tested range ({middles}) and over the whole range.",
            remarks=[f"The interval is that of the surface: {_held(sources)}. Not included:"
                     f" {_left_out(sources)}."],
        )
    )  # fmt: skip


def quality_table(view: ExperimentView, surfaces: ResponseSurfaces) -> PageTable | None:
    """Return how well the surface of each response fits."""
    names, lack = surfaces.response_names, surfaces.lack_of_fit
    units = [response_unit(name, view.units) for name in names]
    sheet = Sheet(view).texts(
        "response", [unit.label(in_words(name)) for name, unit in zip(names, units, strict=True)]
    )
    within = "" if surfaces.blocks is None else " within blocks"
    for heading, shares in (("r²", surfaces.r2), ("adjusted r²", surfaces.adjusted_r2),
                            ("predicted r²", surfaces.predicted_r2)):  # fmt: skip
        sheet.cells(
            f"{heading}{within}",
            [TableCell(share_text(float(one)), repr(float(one)), is_number=True) for one in shares],
        )
    n_terms = len(surfaces.term_names) - 1
    (
        sheet.cells(
            "standard deviation of a run, s [its unit]",
            [number(float(one), unit) for one, unit in zip(surfaces.sigma, units, strict=True)],
        )
        .numbers("F of all terms", surfaces.overall_f, "number")
        .texts("degrees of freedom", [f"{n_terms}, {one}" for one in surfaces.degrees_of_freedom])
        .probabilities("p of F", surfaces.overall_p_value)
        .numbers("F of lack of fit", lack.f, "number")
        .probabilities("p of lack of fit", lack.p_value)
    )
    is_printed = bool(np.isfinite(surfaces.printed_f).any())
    if is_printed:
        sheet.numbers("F as printed in CG-D-39-80", surfaces.printed_f, "number")
    return sheet.table(
        "Quality of each surface. p: probability of an F this large if the terms were zero (F of"
        " all terms) or the surface were adequate (lack of fit).",
        is_compact=True, remarks=[_PRINTED] if is_printed else [],
    )  # fmt: skip


def surface_coefficient_table(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> PageTable | None:
    """Return the coefficients of a surface, coded and in the units of the factors."""
    name = surfaces.response_names[index]
    unit, said = response_unit(name, view.units), in_words(name)
    coded, in_units = (
        _expanded_of_coefficients(view, surfaces, index, in_units=is_it) for is_it in (False, True)
    )
    sources = _shared_by_runs(view, surfaces)
    engineering = [view.coefficient_unit(name, tuple(one.tolist())) for one in surfaces.exponents]
    computed = zip(
        surfaces.coefficient_engineering[index], in_units.all.half, engineering, strict=True
    )
    sheet = Sheet(view).texts("", surfaces.labels)
    sheet.texts("term", [_term_words(powers, view.factors) for powers in surfaces.exponents])
    sheet.measured("coefficient, coded", surfaces.coefficient[index], unit, coded.all)
    if sources:
        sheet.numbers("shared part of ±, coded", coded.shared, unit, 2)
    (
        sheet.numbers("t", surfaces.t[index], "number")
        .probabilities("p", surfaces.p_value[index])
        .cells("coefficient, in units", [_to_compute_with(*one) for one in computed])
        .texts("its unit", [superscript(one.unit) for one in engineering])
    )
    base = _base_response(name)
    of_numbers = (
        f"The {said.split(' of ')[0]} is of the {in_words(base)} as a number of"
        f" {superscript(QUANTITIES[base].unit)}, whatever units the page shows."
        if name != base
        else ""
    )
    units = ", ".join(
        f"{in_words(factor)} in {one.unit}"
        for factor, one in zip(view.factors, view.factor_units, strict=True)
    )
    return sheet.table(
        f"{said[0].upper()}{said[1:]}: coefficients of the surface, for coded levels and for levels"
        " in units.",
        remarks=list(filter(None, [
            of_numbers,
            f"In units: {units}. The digits suffice for computation. Errors of the coefficients"
            " are correlated: a value of the surface is known much better than their sum suggests.",
            plus_minus(sheet.factors, _held(sources), left_out=_left_out(sources)),
            "Shared part: the part of ± common to all runs, with the same k; parts combine in"
            " quadrature. t and p are for the scatter alone." if sources else "",
        ])),
    )  # fmt: skip


def anova_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> PageTable | None:
    """Return the analysis of variance of a surface."""
    anova, name = surfaces.anova, surfaces.response_names[index]
    unit = response_unit(name, view.units)
    square = Shown(_squared(unit.unit), unit.factor**2)
    is_large = bool(np.nanmax(anova.sum_of_squares[index]) * square.factor >= _LARGE)
    sheet = Sheet(view).texts("source", anova.source)
    sheet.counts("degrees of freedom", anova.degrees_of_freedom[index])
    for heading, values in (("sum of squares", anova.sum_of_squares[index]),
                            ("mean square", anova.mean_square[index])):  # fmt: skip
        sheet.cells(
            square.label(heading),
            [
                TableCell(f"{one * square.factor:.3e}", repr(float(one)), is_number=True)
                if is_large
                else number(float(one), square)
                for one in values
            ],
        )
    return (
        sheet.numbers("F", anova.f[index], "number")
        .probabilities("p", anova.p_value[index])
        .texts("tested against", anova.error_term)
        .table(f"{in_words(name).capitalize()}: sequential analysis of variance.")
    )


def _held(sources: Sequence[str]) -> str:
    """Describe the uncertainty of a surface."""
    told = ", ".join(source_words(one) for one in sources)
    return f"{_OF_RUNS}; and errors common to all runs: {told}" if told else _OF_RUNS


def _left_out(sources: Sequence[str]) -> str:
    return _ONE_LINE if sources else NOT_OF_RUNS


def _to_compute_with(value: float, spread: float, unit: Shown) -> TableCell:
    """Return a coefficient to seven digits and its uncertainty to two."""
    if not np.isfinite(value):
        return TableCell(NOT_GIVEN, is_number=True)
    half = f" ± {number_text(spread * unit.factor, 2)}" if np.isfinite(spread) else ""
    text = f"{number_text(value * unit.factor, 7)}{half}"
    return TableCell(text, repr(float(value)), is_number=True)


def _squared(unit: str) -> str:
    return unit if unit == "1" else f"({unit})²" if " " in unit or "/" in unit else f"{unit}²"


def line_of_runs_table(view: ExperimentView, tests: Mapping[str, TestView]) -> PageTable | None:
    """Return the line parameters of each run, with those derived from surfaces."""
    constant, time = (
        view.per_run(f"derived_{name}")
        for name in ("dissipation_spring_constant", "relaxation_time")
    )
    sheets, used = [], []
    pairs = zip(view.texts("run_name"), view.texts("run_specimen"), strict=True)
    for k, (run, specimen) in enumerate(pairs):
        test = tests.get(run)
        if test is None or "test_relaxation_time" not in test.data:
            continue
        used.append(test)
        sheet = Sheet(test, ("specimen",)).keep(np.array([test.specimens.index(specimen)]))
        add_line(sheet.texts("run", [view.runs[k]]), test)
        sheet.numbers("K_1 from surfaces", constant[[k]], "tension")
        sheets.append(sheet.numbers("tau from surfaces", time[[k]], "time"))
    found = Sheet.stack(sheets)
    return found.table(
        "The three-parameter line of each run; at the right K_1 and tau from surfaces of E' and E''"
        " at the same levels, which smooth over the runs.",
        is_compact=True, optional=(REFUSED,), remarks=[CONDITIONING, *about_line(found, used)],
    )  # fmt: skip


def _forms(view: ExperimentView, *dims: str) -> Sheet:
    """One row per form, or per coefficient of a form; none without any fit."""
    sheet = Sheet(view, ("stiffness_form", *dims))
    if not np.isfinite(view.array("stiffness_n_coefficients")).any():
        sheet.keep(np.zeros(sheet.n_rows, dtype=bool))
    if dims:
        sheet.keep(sheet.of("stiffness_coefficient_name", "").astype(str) != "")
    names = map(str, sheet.of("stiffness_form", ""))
    return sheet.texts("form", [FORM_WORDS.get(name, name) for name in names])


def form_table(view: ExperimentView) -> PageTable | None:
    """Return the coefficients of the stiffness forms with their intervals."""
    sheet = _forms(view, "stiffness_term")
    if not sheet.n_rows:
        return None
    low, high = (sheet.of(f"stiffness_coefficient_{end}") for end in ("low", "high"))
    half, spread = (high - low) / 2, sheet.of("stiffness_coefficient_standard_uncertainty")
    confidence = 100 * float(np.nanmax(view.array("stiffness_confidence")))
    (
        sheet.texts("coefficient", "stiffness_coefficient_name")
        .measured("value", sheet.of("stiffness_coefficient"), None, Expanded(half, half / spread))
        .texts("unit", "stiffness_coefficient_unit")
        .cells(
            f"{confidence:g} % interval",
            [
                TableCell(f"{a:.4g} to {b:.4g}", f"{float(a)!r} {float(b)!r}", is_number=True)
                for a, b in zip(low, high, strict=True)
            ],
        )
        .probabilities("p if zero", "stiffness_p_value")
    )
    return sheet.table(
        "Coefficients of the stiffness forms of mooring codes.",
        remarks=[plus_minus(sheet.factors, "scatter of the runs about the form",
                            left_out="error of the form itself: see its quality")],
    )  # fmt: skip


def form_quality_table(view: ExperimentView) -> PageTable | None:
    """Return how well each form fits the runs, compared with the quadratic surface."""
    sheet = _forms(view)
    if not sheet.n_rows:
        return None
    strength = float(np.nanmax(view.per_run("run_rated_break_strength")))
    unit = response_unit("apparent_spring_constant", view.units)
    return (
        sheet.counts("coefficients", "stiffness_n_coefficients")
        .numbers("r²", "stiffness_r2")
        .numbers("adjusted r²", "stiffness_adjusted_r2")
        .numbers("predicted r²", "stiffness_predicted_r2")
        .numbers("s over break strength", "stiffness_sigma")
        .numbers("s", "stiffness_sigma", Shown(unit.unit, unit.factor * strength))
        .numbers("AICc", "stiffness_aicc")
        .table(
            "The forms against the quadratic surface of the same runs.",
            remarks=["s: standard deviation of a run about the form. AICc: lower is better;"
                     " compare only forms fitted to the same runs."],
        )
    )  # fmt: skip


_RUN_TO_RUN, _REGRESSION = "run_to_run", "regression"


def coefficient_budgets(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> list[AnswerBudget]:
    """Return the budget of each coded coefficient of a surface, with shared and random errors."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    share = _share_of_repeats(surfaces, index)
    labels = {label: place for place, label in enumerate(surfaces.labels)}
    found = []
    for one in all_budgets(view.data, f"{name}_coefficient"):
        if one.place["experiment"] != view.name or not one.standard_uncertainty > 0:
            continue
        place = labels[one.place["term"]]
        powers = surfaces.exponents[place]
        found.append(
            AnswerBudget(
                f"{one.place['term']}, {_term_words(powers, view.factors)}", "", unit,
                _apart(one, share),
            )
        )  # fmt: skip
    return found


def _share_of_repeats(surfaces: ResponseSurfaces, index: int) -> float:
    """Share of repeated runs in the variance about a surface; NaN without repeats."""
    anova = surfaces.anova
    row = anova.source.index("pure error")
    freedom = float(anova.degrees_of_freedom[index, row])
    variance = float(surfaces.sigma[index]) ** 2
    if not (freedom > 0 and variance > 0):
        return float("nan")
    return float(min(anova.sum_of_squares[index, row] / freedom / variance, 1.0))


def _apart(budget: Budget, share: float) -> Budget:
    """Budget with the scatter about the surface in two parts; in one without repeated runs."""
    parts = {_REGRESSION: 1.0} if np.isnan(share) else {
        _RUN_TO_RUN: share, _REGRESSION: 1 - share,
    }  # fmt: skip
    rows = []
    for one in budget.rows:
        if one.source != RANDOM:
            rows.append(one)
            continue
        rows += [
            BudgetRow(source, "", one.contribution * np.sqrt(part), one.share * part)
            for source, part in parts.items()
        ]
    return replace(budget, rows=tuple(sorted(rows, key=lambda row: -row.share)))


def coefficient_budget_table(
    view: ExperimentView, name: str, answers: Sequence[AnswerBudget]
) -> PageTable | None:
    """Return the values behind the bars: value, uncertainty, factor, and share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(one.words),
            one.cell,
            number(one.budget.coverage_factor, digits=3),
            *(_percent(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        f"{in_words(name).capitalize()}: share of each source in the variance of the coefficients.",
        ("coefficient, coded", answers[0].unit.label("value"), "k",
         *(f"{source_words(one)} [%]" for one in sources)),
        rows, is_compact=True,
        remarks=[f"±: expanded uncertainty, 95 % ({factors}).", source_meanings(sources)],
    )  # fmt: skip


def _percent(value: float) -> TableCell:
    return TableCell(f"{100 * value:.1f}", repr(value), is_number=True)


def experiment_findings(view: ExperimentView) -> list[SummaryFinding]:
    """Return what a reader must know about an experiment before its numbers."""
    name = f"experiment {view.name}"
    found = [
        SummaryFinding("warning", (name,), row["caution"] + _of_runs(row))
        for row in view.own_rows("caution")
    ]
    surfaces = view.surfaces
    if surfaces is not None:
        negative = negative_inside(surfaces)
        found += [
            SummaryFinding("warning", (name,), f"{in_words(one)}: {_lower(text)}")
            for one in surfaces.response_names
            for text in negative_words(view, surfaces, one, negative)
        ]
    return found + [
        SummaryFinding(one.severity, (name,), str(one), urgency(one)) for one in view.notes
    ]


def negative_words(
    view: ExperimentView,
    surfaces: ResponseSurfaces,
    name: str,
    negative: Mapping[str, tuple[float, Floats]],
) -> list[str]:
    """Warn of a surface with values that its response cannot have."""
    if name not in negative:
        return []
    least, place = negative[name]
    unit = response_unit(name, view.units)
    at = ", ".join(
        f"{number_text(low + (one + 1) / 2 * (high - low), 3)} {own.unit}"
        for one, own, (low, _, high) in zip(
            place, view.factor_units, map(view.levels, range(len(view.factors))), strict=True
        )
    )
    bent = [one for one in surfaces.response_names if one != name and _base_response(one) == name]
    instead = (
        f"Use the surface of its {in_words(bent[0]).split(' of ')[0]} below, which stays positive."
        if bent
        else f'Request one that cannot: transform = {{ {name} = "log" }} in the campaign.'
    )
    return [
        f"This surface falls to {number_text(least * unit.factor, 3)}"
        f"{'' if unit.unit == '1' else ' ' + unit.unit} inside the tested range (at {at}), and"
        f" a {in_words(name)} cannot be negative. {instead}"
    ]


def quality_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Describe the fit of a surface, and that the report would print another F."""
    lack = surfaces.lack_of_fit
    unit = response_unit(surfaces.response_names[index], view.units)
    freedom = int(surfaces.degrees_of_freedom[index])
    shares = [
        share_text(float(one[index]))
        for one in (surfaces.r2, surfaces.adjusted_r2, surfaces.predicted_r2)
    ]
    scatter = number_text(float(surfaces.sigma[index]) * unit.factor, 3)
    sentences = [
        f"r² {shares[0]}, adjusted {shares[1]}, predicted {shares[2]}; standard deviation of a run"
        f" about the surface {scatter}{'' if unit.unit == '1' else ' ' + unit.unit}."
        f" F({len(surfaces.term_names) - 1}, {freedom}) ="
        f" {number_text(float(surfaces.overall_f[index]))},"
        f" {_p(float(surfaces.overall_p_value[index]))}."
    ]
    reason = LACK_OF_FIT_REASONS[int(lack.reason[index])]
    if reason:
        sentences.append(f"No test of lack of fit: {reason}.")
    else:
        p = float(lack.p_value[index])
        verdict = (
            "the runs deviate from the surface by more than repeated runs scatter"
            if p < _SIGNIFICANCE
            else "no lack of fit beyond the scatter of repeated runs"
        )
        sentences.append(
            f"Lack of fit: F({lack.degrees_of_freedom[index]},"
            f" {lack.pure_error_degrees_of_freedom[index]}) = {number_text(float(lack.f[index]))},"
            f" {_p(p)}: {verdict}."
        )
    if np.isfinite(surfaces.printed_f[index]):
        sentences.append(
            "For comparison only: the F that CG-D-39-80 prints, with the mean among the terms, is"
            f" {number_text(float(surfaces.printed_f[index]))} here."
        )
    return " ".join(sentences)


_SIGNIFICANCE = 0.05


def stationary_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Describe a maximum or minimum of the surface, and its place."""
    canonical = surfaces.canonical
    reason = STATIONARY_REASONS[int(canonical.reason[index])]
    if reason:
        return f"No stationary point: {reason}."
    kind = STATIONARY_KINDS[int(canonical.kind[index])]
    if not canonical.is_inside[index]:
        return (
            f"Stationary point: a {kind}, outside the tested range: within it the surface has no"
            " maximum or minimum, and its extremes lie on the boundary."
        )
    unit = response_unit(surfaces.response_names[index], view.units)
    at = ", ".join(
        f"{in_words(name)} {number_text(float(value) * one.factor, 3)} {one.unit} (coded"
        f" {coded:+.2f} ± {spread:.2g})"
        for name, value, one, coded, spread in zip(
            view.factors, canonical.stationary_point_engineering[index], view.factor_units,
            canonical.stationary_point[index],
            canonical.stationary_point_standard_uncertainty[index], strict=True,
        )
    )  # fmt: skip
    value = number_text(float(canonical.stationary_value[index]) * unit.factor)
    return f"Stationary point: a {kind} of {value} {unit.unit} inside the tested range, at {at}."


def block_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> list[str]:
    """Describe the differences between specimens where there are several."""
    blocks = surfaces.blocks
    if blocks is None:
        return []
    unit = response_unit(surfaces.response_names[index], view.units)
    said = "" if unit.unit == "1" else f" {unit.unit}"
    if blocks.treatment == "random":
        spread = number_text(float(blocks.standard_deviation[index]) * unit.factor, 3)
        none = " (no more than runs of one specimen do)" if blocks.at_boundary[index] else ""
        return [
            f"{len(blocks.names)} specimens, taken as a sample of others: they differ by a standard"
            f" deviation of {spread}{said}{none}."
        ]
    effects = ", ".join(
        f"{name} {float(effect) * unit.factor:+.3g}{said}"
        for name, effect in zip(blocks.names, blocks.effect[index], strict=True)
    )
    return [f"Difference of each specimen from their mean, at the same levels: {effects}."]


def single_time_words(view: ExperimentView) -> list[str]:
    """Describe whether one relaxation time holds over frequency."""
    verdict = view.text("single_time_verdict")
    if not verdict:
        return []
    exponent = view.scalar("single_time_exponent")
    if not np.isfinite(exponent):
        return [f"A single relaxation time over frequency: {verdict}."]
    low, high = (view.scalar(f"single_time_exponent_{end}") for end in ("low", "high"))
    tolerance = view.scalar("single_time_tolerance")
    ratio, span = view.scalar("single_time_ratio"), view.scalar("single_time_frequency_ratio")
    return [
        f"A single relaxation time over frequency: {verdict}. With tau ~ f⁻ⁿ, n = {exponent:.4f}"
        f" ({low:.4f} to {high:.4f}; 0 is one relaxation time and 1 is 1/f, either met to within"
        f" {tolerance:g}); over a frequency ratio of {span:.3g} the relaxation time changes by a"
        f" factor of {ratio:.3g}."
    ]


def form_words(view: ExperimentView) -> list[str]:
    """Describe each form in words, and its fit compared with the quadratic surface."""
    equations = view.array_of_texts("stiffness_equation")
    if not equations.size or not any(equations):
        return []
    forms = [str(name) for name in view.data["stiffness_form"].values]
    sentences = [
        f"{FORM_WORDS.get(name, name)}: {_FORM_SENTENCES.get(name, '')}{text}."
        for name, text in zip(forms, equations, strict=True)
        if text
    ]
    scatter = view.array("stiffness_sigma")
    low = float(np.nanmin(view.array("stiffness_mean_load_low")))
    high = float(np.nanmax(view.array("stiffness_mean_load_high")))
    text = (
        f"Range of use: mean tension {100 * low:.3g} to {100 * high:.3g} % of the break strength,"
        " and the amplitudes and frequencies of the runs."
    )
    if "quadratic" in forms and scatter[forms.index("quadratic")] > 0:
        over = scatter / scatter[forms.index("quadratic")]
        more = [
            f"{over[k]:.3g} for {FORM_WORDS.get(name, name)}"
            for k, name in enumerate(forms)
            if name != "quadratic" and np.isfinite(over[k])
        ]
        text += (
            " Standard deviation of a run about the form, over that about the quadratic surface:"
            f" {', '.join(more)}."
        )
    return [*sentences, text]


_FORM_SENTENCES = {
    "del-vecchio": "stiffness over break strength is a constant, plus a share of the mean load,"
    " less a share of the load amplitude and of the logarithm of the period; ",
    "mean-load": "stiffness is a share of the break strength plus a multiple of the mean tension,"
    " whatever amplitude and period; ",
}


def _p(value: float) -> str:
    return "p < 0.0001" if value < 1e-4 else f"p = {value:.4f}"


def _of_runs(row: Mapping[str, str]) -> str:
    runs = row.get("caution_runs", "")
    return f" ({runs})" if runs else ""


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


_FORM_GREY = "#8C8C8C"


def draw_single_time(
    view: ExperimentView, tests: Mapping[str, TestView] | None = None
) -> list[Figure]:
    """Draw the relaxation time against frequency, with the lines of one time and of 1/f."""
    exponent = view.scalar("single_time_exponent")
    unit = shown("time", view.units)
    frequency = view.per_run("run_frequency")
    time = view.per_run("relaxation_time_measured") * unit.factor
    spread = _expanded_of_runs(view, "relaxation_time", {} if tests is None else tests)
    half = spread.half * unit.factor
    known = np.isfinite(frequency) & (time > 0)
    if not np.isfinite(exponent) or "frequency" not in view.factors or not known.any():
        return []
    groups = _groups(view, known)
    data: list[Trace] = []
    reach = np.array([frequency[known].min() / 1.1, frequency[known].max() * 1.1])
    centre = np.exp(np.mean(np.log(frequency[known]))), np.exp(np.mean(np.log(time[known])))
    for name, power, dash in (("one time, f⁰", 0.0, "dot"), ("as 1/f", 1.0, "dash")):
        y = centre[1] * (reach / centre[0]) ** -power
        data.append(line(reach, y, name=name, colour=_FORM_GREY, dash=dash, width=2))
    several = [own for own in groups.values() if np.unique(np.round(frequency[own], 3)).size > 1]
    for place, own in enumerate(several):
        height = np.exp(np.mean(np.log(time[own] * frequency[own] ** exponent)))
        tint = colour(place)
        ends = np.array([frequency[own].min(), frequency[own].max()])
        data.append(
            line(
                ends, height * ends**-exponent, name="fit", colour=tint, width=1.2,
                showlegend=False, hoverinfo="skip",
            )
        )  # fmt: skip
        data.append(
            _timed(view, own, (frequency, time, half), tint, SYMBOLS[place % len(SYMBOLS)],
                   _loads(view, own))
        )  # fmt: skip
    rest = np.array(sorted(set(np.flatnonzero(known)) - {k for own in several for k in own}), int)
    if rest.size:
        data.append(
            _timed(view, rest, (frequency, time, half), _FORM_GREY, "circle-open",
                   "loads at one frequency only")
        )  # fmt: skip
    low, high = (view.scalar(f"single_time_exponent_{end}") for end in ("low", "high"))
    times = time[known]
    span: dict[str, Any] = {}
    if times.max() < 3 * times.min():
        # a constant would fill the height otherwise, and noise would look like a law
        middle = np.log10(centre[1])
        span["range"] = [float(middle - 0.5), float(middle + 0.5)]
    return [
        make_figure(
            f"{view.key}-single-time", f"{view.name}: relaxation time against frequency",
            "Relaxation time of each run, on logarithmic axes. One relaxation time would lie on the"
            " dotted level; dashed: as 1/f, a loss angle that does not change with frequency."
            f" Thin: the fit, tau ~ f⁻ⁿ with n = {exponent:.4f} ({low:.4f} to"
            f" {high:.4f}), one factor for each pair of loads. Bars: expanded"
            f" uncertainty (95 %, {factor_words(spread.factors)}).",
            data, synthetic=view.is_synthetic, height=420, is_wide=True,
            xaxis=axis("frequency [Hz]", type="log", **_decade_ticks(reach)),
            yaxis=axis(unit.label("relaxation time"), type="log", **span),
        )
    ]  # fmt: skip


def draw_forms(view: ExperimentView) -> list[Figure]:
    """Draw the spring constant by each form of stiffness against the measured one."""
    unit = response_unit("apparent_spring_constant", view.units)
    measured = view.per_run("apparent_spring_constant_measured") * unit.factor
    fitted = view.array("stiffness_fitted")
    if fitted.size == 0 or not np.isfinite(fitted).any():
        return []
    forms = [str(name) for name in view.data["stiffness_form"].values]
    rows = {
        name: fitted[k] * unit.factor
        for k, name in enumerate(forms)
        if np.isfinite(fitted[k]).any()
    }
    rows["quadratic"] = view.per_run("apparent_spring_constant_fitted") * unit.factor
    known = np.isfinite(measured)
    everything = np.concatenate([measured[known], *(values[known] for values in rows.values())])
    ends = np.array([np.nanmin(everything), np.nanmax(everything)])
    force = shown("tension", view.units)
    tension = view.per_run("run_mean_tension") * force.factor
    span = np.array([np.nanmin(tension), np.nanmax(tension)])
    equal, missed = (
        [line(x, y, name="equal", colour=_FORM_GREY, dash="dot", showlegend=False)]
        for x, y in ((ends, ends), (span, np.zeros(2)))
    )
    for place, (name, values) in enumerate(rows.items()):
        equal.append(_by_form(view, place, name, measured, values))
        missed.append(_by_form(view, place, name, tension, measured - values))
    return [
        make_figure(
            f"{view.key}-forms", f"{view.name}: stiffness forms of mooring codes",
            "Apparent spring constant by each form against the measured value, one point per run;"
            " dotted: equal.",
            equal, synthetic=view.is_synthetic, height=400,
            xaxis=axis(unit.label("measured")), yaxis=axis(unit.label("by the form")),
        ),
        make_figure(
            f"{view.key}-forms-missed", f"{view.name}: residuals of the forms",
            "Measured minus form, against mean tension. A bend is curvature that a linear form"
            " cannot follow.",
            missed, synthetic=view.is_synthetic, height=400,
            xaxis=axis(force.label("mean tension")),
            yaxis=axis(unit.label("measured less form")),
        ),
    ]  # fmt: skip


def _by_form(view: ExperimentView, place: int, name: str, x: Floats, y: Floats) -> Trace:
    return {
        "type": "scatter", "mode": "markers", "name": FORM_WORDS.get(name, name),
        "x": plain_numbers(x), "y": plain_numbers(y),
        "text": [plot_text(run) for run in view.runs],
        "marker": {"size": 8, "color": COLOURS[place], "symbol": SYMBOLS[place]},
    }  # fmt: skip


def _groups(view: ExperimentView, known: Bools) -> dict[tuple[str, ...], Integers]:
    """Runs at equal planned loads of one specimen: places by their common levels."""
    frequency = view.factors.index("frequency")
    others = np.delete(view.array("run_plan"), frequency, axis=1)
    specimens = view.texts("run_specimen")
    found: dict[tuple[str, ...], list[int]] = {}
    for k in np.flatnonzero(known):
        found.setdefault((specimens[k], *map(str, others[k])), []).append(int(k))
    return {key: np.array(own) for key, own in found.items()}


def _loads(view: ExperimentView, own: Integers) -> str:
    """Give the levels of a group of runs, except the frequency."""
    level = view.array("run_level")[own].mean(axis=0)
    parts = [
        f"{number_text(float(level[j]) * unit.factor, 3)} {unit.unit}"
        for j, unit in enumerate(view.factor_units)
        if view.factors[j] != "frequency"
    ]
    specimens = view.texts("run_specimen")
    who = f"{specimens[own[0]]}: " if len(set(specimens)) > 1 else ""
    return who + ", ".join(parts)


def _timed(
    view: ExperimentView,
    own: Integers,
    columns: tuple[Floats, Floats, Floats],
    tint: str,
    symbol: str,
    name: str,
) -> Trace:
    frequency, time, half = (column[own] for column in columns)
    return {
        "type": "scatter", "mode": "markers", "name": plot_text(name),
        "x": plain_numbers(frequency), "y": plain_numbers(time),
        "text": [plot_text(view.runs[k]) for k in own],
        "error_y": {"type": "data", "array": plain_numbers(half), "color": tint, "thickness": 1},
        "marker": {"size": 8, "color": tint, "symbol": symbol},
    }  # fmt: skip


def _decade_ticks(reach: Floats) -> dict[str, Any]:
    """Return ticks at 1, 2 and 5 of each decade: plotly labels others with bare digits."""
    powers = np.arange(np.floor(np.log10(reach[0])) - 1, np.ceil(np.log10(reach[1])) + 1)
    ticks = [
        digit * 10.0**power
        for power in powers
        for digit in (1, 2, 3, 5)
        if reach[0] / 1.5 <= digit * 10.0**power <= reach[1] * 1.5
    ]
    return {
        "tickvals": plain_numbers(np.array(ticks)),
        "ticktext": [f"{tick:.3g}" for tick in ticks],
    }
