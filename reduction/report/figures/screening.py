"""Effects of a Plackett-Burman design: which of many factors move a response at all."""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
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
from reduction.report.style import COLOURS, plot_text
from reduction.surface.confounding import alias_matrix, half_normal_coordinates

_GREY = "#8C8C8C"
_LEAST_ALIAS = 1e-6
_FULL = 1 - 1e-6
_OF_DUMMIES, _OF_FACTORS, _SEEN = _GREY, COLOURS[5], COLOURS[0]


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
        line(reach, reach * spread, name="scatter alone", colour=_GREY, dash="dot")
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
