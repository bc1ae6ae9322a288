"""Figures of experiments: surfaces, contours, residuals, effects, stiffness forms, one time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from reduction.experiments.fit_results import (
    ResponseSurfaces,
)
from reduction.experiments.surface_points import (
    ABOVE_LEVERAGE,
    SurfaceValues,
    evaluate_surfaces,
    greatest_leverage,
)
from reduction.record.measurement import Bools, Floats, Integers
from reduction.report.figure_data import (
    Figure,
    Trace,
    axis,
    if_any,
    line,
    make_figure,
    named_axis,
    plain_numbers,
)
from reduction.report.product_views import (
    FORM_WORDS,
    ExperimentView,
    base_response,
    expanded_of_runs,
    in_words,
    response_unit,
)
from reduction.report.test_view import (
    TestView,
    factor_words,
)
from reduction.report.text_style import (
    COLOURS,
    SYMBOLS,
    Shown,
    colour,
    faded,
    number_text,
    plot_text,
    shown,
)

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


_SCALE = [[0.0, "#e4eef6"], [0.5, "#97c4e3"], [1.0, "#3a8fc8"]]

"""Light enough everywhere for dark labels on it."""


_INK, _GREY = "#1b1f23", "#8C8C8C"


_DIGITS = 4


def draw_surface(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: _Planes
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
    return if_any(
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
    if name == base_response(name):
        return ""
    return f", fitted to the {in_words(name)} and transformed back (medians)"


def _points_in_space(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, planes: _Planes
) -> list[Trace]:
    """Return the runs of the middle plane, and a line from each to the surface there."""
    name = base_response(surfaces.response_names[index])
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


_FORM_GREY = "#8C8C8C"


def draw_single_time(view: ExperimentView, tests: Mapping[str, TestView]) -> list[Figure]:
    """Draw the relaxation time against frequency, with the lines of one time and of 1/f."""
    exponent = view.scalar("single_time_exponent")
    unit = shown("time", view.units)
    frequency = view.per_run("run_frequency")
    time = view.per_run("relaxation_time_measured") * unit.factor
    spread = expanded_of_runs(view, "relaxation_time", tests)
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
