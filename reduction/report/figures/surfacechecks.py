"""How well a surface fits: terms by size, predicted against actual, residuals."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.special import ndtri, stdtrit

from reduction.record import Bools, Floats, Integers
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figure import (
    Figure,
    Trace,
    axis,
    line,
    make_figure,
    named_axis,
    plain_numbers,
)
from reduction.report.style import COLOURS, Shown, plot_text
from reduction.surface.product import ResponseSurfaces

CONFIDENCE = 0.95
_GREY = "#8C8C8C"


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
            (~counts, _GREY, "not told from zero"),
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
    data = [line(ends, ends, name="equal", colour=_GREY, dash="dot", showlegend=False), points]
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
        line(ends, ends, name="normal", colour=_GREY, dash="dot", showlegend=False),
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
