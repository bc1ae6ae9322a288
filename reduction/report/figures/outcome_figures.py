"""Figures of outcomes without a log: the forms of Figures 15 and 19 of [1]_.

Strength against years in the field, cycles to failure against peak load.

References
----------
.. [1] CG-D-39-80.
"""

from __future__ import annotations

import numpy as np

from reduction.experiments.life_statistics import life_at_load
from reduction.experiments.outcome_groups import (
    ExposureSeries,
    Group,
    LoadSeries,
    exposure_series,
    load_series,
)
from reduction.experiments.strength_statistics import strength_after
from reduction.record.measurement import Floats
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.product_views import OutcomeView, group_names, line_of
from reduction.report.text_style import colour, marker, plot_text, shown

_POINTS = 81

_PERCENT = 100.0

_ALPHA = 0.18


def draw_exposure(view: OutcomeView) -> list[Figure]:
    """Draw strength against years in the field, one figure a line."""
    series = exposure_series(view.outcomes)
    names = group_names([one.group for one in series], view.units)
    unit = shown("tension", view.units)
    return [
        make_figure(
            f"outcomes-exposure-{index}", f"Strength against exposure, {name}",
            "Each break; a triangle is a lower bound (the termination broke first, or the test was"
            " stopped) and is not in the fit. Line: least squares over the breaks; shaded: 95 %"
            " interval of the mean strength, inside the tested exposures only.",
            _exposure_traces(one, index, unit.factor), synthetic=view.is_synthetic, height=400,
            xaxis=axis("time in the field [year]"),
            yaxis=axis(unit.label("tensile strength"), rangemode="tozero"),
        )
        for index, (one, name) in enumerate(zip(series, names, strict=True))
    ]  # fmt: skip


def _exposure_traces(series: ExposureSeries, index: int, factor: float) -> list[Trace]:
    data: list[Trace] = []
    if series.fit is not None:
        years = np.linspace(series.fit.exposure_low, series.fit.exposure_high, _POINTS)
        mean, low, high, _ = strength_after(series.fit, years)
        data += [
            band(years, factor * low, factor * high, name="95 % interval", colour=colour(index),
                 alpha=_ALPHA),
            line(years, factor * mean, name="fitted line", colour=colour(index)),
        ]  # fmt: skip
    is_bound = series.is_lower_bound
    strength = factor * series.strength
    data += _points(series.exposure[~is_bound], strength[~is_bound], "breaks", index)
    return data + _points(series.exposure[is_bound], strength[is_bound], "at least", index, "up")


def draw_lives(view: OutcomeView) -> list[Figure]:
    """Draw cycles to failure against peak load, one figure a line, its conditions in colours."""
    by_line: dict[Group, list[LoadSeries]] = {}
    for series in load_series(view.outcomes):
        by_line.setdefault(line_of(series.group), []).append(series)
    titles = group_names(list(by_line), view.units)
    return [
        make_figure(
            f"outcomes-lives-{number}", f"Cycles to failure against peak load, {title}",
            "Each test; an arrow is a run-out or a failure of the termination: the line lasts at"
            " least that. Line: median life, run-outs counted as what they are; shaded: its 95 %"
            " bounds, between the loads tested only. The law has no fatigue limit.",
            [
                trace
                for index, (series, name) in enumerate(
                    zip(own, group_names([one.group for one in own], view.units), strict=True)
                )
                for trace in _life_traces(series, name if len(own) > 1 else "", index)
            ],
            synthetic=view.is_synthetic, height=440, is_wide=True,
            xaxis=axis("peak load [% of rated break strength]"),
            yaxis=axis("cycles [1]", type="log", exponentformat="power"),
        )
        for number, (title, own) in enumerate(zip(titles, by_line.values(), strict=True))
    ]  # fmt: skip


def _life_traces(series: LoadSeries, name: str, index: int) -> list[Trace]:
    prefix = f"{name}: " if name else ""
    data: list[Trace] = []
    if series.fit is not None:
        load = np.linspace(series.fit.load_ratio_low, series.fit.load_ratio_high, _POINTS)
        life, low, high, _ = life_at_load(series.fit, load)
        data += [
            band(_PERCENT * load, low, high, name=f"{prefix}95 % bounds", colour=colour(index),
                 alpha=_ALPHA),
            line(_PERCENT * load, life, name=f"{prefix}median life", colour=colour(index)),
        ]  # fmt: skip
    load, suspended = _PERCENT * series.peak_load_ratio, series.is_suspended
    data += _points(load[~suspended], series.cycles[~suspended], f"{prefix}failed", index)
    run_outs = f"{prefix}at least"
    return data + _points(load[suspended], series.cycles[suspended], run_outs, index, "arrow")


def _points(x: Floats, y: Floats, name: str, index: int, bound: str = "") -> list[Trace]:
    """Points of values, or of lower bounds; nothing where there are none."""
    if not x.size:
        return []
    style = marker(index, size=8)
    if bound:
        style |= {"symbol": "arrow-up" if bound == "arrow" else "triangle-up-open", "size": 11}
    return [
        {
            "type": "scatter",
            "mode": "markers",
            "name": plot_text(name),
            "x": plain_numbers(x),
            "y": plain_numbers(y),
            "marker": style,
        }
    ]
