"""Figures over the tests of a campaign: the forms of Figures 31, 34 and 35 of [1]_.

All moduli in one, start against end of a long test, static against dynamic.

References
----------
.. [1] WHOI-2005-10, sec. 4.5 to 4.8.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.report.figure import (
    Figure,
    Trace,
    axis,
    band,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.figures.ratios import heights
from reduction.report.style import DASHES, colour, marked, marker, plot_text, shown
from reduction.report.uncertainty import (
    NORMAL,
    expanded_of,
    factor_words,
    plus_minus_of_tests,
)
from reduction.report.view import TestView, all_specimens, any_synthetic
from reduction.units import UnitSystem
from reduction.vocabulary import BRANCH_NAMES, BRANCH_VALUES


def draw_all_moduli(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the modulus of every test in one figure a specimen, a colour and a marker a test."""
    found = []
    for order, specimen in enumerate(all_specimens(tests)):
        own = [(index, view) for index, view in enumerate(tests) if _has_curve(view, specimen)]
        data = [trace for index, view in own for trace in _curves(view, specimen, index)]
        if not data:
            continue
        units = tests[0].units
        found.append(
            make_figure(
                f"campaign-moduli-{order}", f"All tests: modulus, {specimen}",
                "Mean tangent modulus of every test against strain; ascending solid, descending"
                f" dashed. {_about_bands([view for _, view in own])}",
                data, synthetic=any_synthetic(tests), height=480, is_wide=True,
                xaxis=axis(shown("strain", units).label("strain")),
                yaxis=_modulus_axis(data, units),
            )
        )  # fmt: skip
    return found


def draw_parts(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the logs that repeat parts of one long test together, one figure a specimen."""
    groups: dict[str, list[tuple[int, TestView]]] = {}
    for index, view in enumerate(tests):
        if view.attribute("part_of"):
            groups.setdefault(view.attribute("part_of"), []).append((index, view))
    found: list[Figure] = []
    for whole, members in groups.items():
        parts = [view for _, view in members]
        for specimen in all_specimens(parts):
            data = [trace for index, view in members for trace in _curves(view, specimen, index)]
            if data and len(parts) > 1:
                found.append(
                    make_figure(
                        f"campaign-parts-{len(found)}", f"{whole}: its parts, {specimen}",
                        f"Mean tangent modulus in the parts of {whole} that were logged apart:"
                        f" what the long test changed. {_about_bands(parts)}",
                        data, synthetic=any_synthetic(parts), height=400,
                        xaxis=axis("strain [%]"),
                        yaxis=_modulus_axis(data, whole_units(parts)),
                    )
                )  # fmt: skip
    return found


def draw_static_dynamic(tests: Sequence[TestView]) -> list[Figure]:
    """Draw interval moduli of stepwise tests over the curves of the cyclic ones."""
    places = list(enumerate(tests))
    stepwise = [(k, view) for k, view in places if view.array("interval_modulus") is not None]
    dynamic = [(k, view) for k, view in places if view.array("tangent_modulus") is not None]
    if not stepwise or not dynamic:
        return []
    units = tests[0].units
    in_stress, in_strain = shown("stress", units), shown("strain", units)
    names = all_specimens(tests)
    found = []
    for place, branch in enumerate(BRANCH_NAMES):
        data: list[Trace] = []
        for index, view in dynamic:
            strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
            if strain is None or modulus is None:
                continue
            for order, specimen in enumerate(view.specimens):
                data.append(
                    line(
                        strain * in_strain.factor, modulus[order, place] * in_stress.factor,
                        name=f"{view.id}, {specimen}", colour=colour(index), dash=DASHES[branch],
                        width=1.4, **marked(index, names.index(specimen)),
                    )
                )  # fmt: skip
        for index, view in stepwise:
            data.append(_static(view, branch, index, in_stress.factor))
        found.append(
            make_figure(
                f"campaign-static-{branch}", f"Static against dynamic, {branch}",
                "Interval moduli of the stepwise tests (markers; bars, ±: expanded uncertainty,"
                f" 95 % ({factor_words([NORMAL])})) over the tangent moduli of the cyclic tests"
                f" (lines), {branch}.",
                data, synthetic=any_synthetic(tests), height=420, is_wide=True,
                xaxis=axis(in_strain.label("strain")),
                yaxis=axis(in_stress.label("modulus"), rangemode="tozero"),
            )
        )  # fmt: skip
    return [figure for figure in found if figure.has_data]


def whole_units(tests: Sequence[TestView]) -> UnitSystem:
    """Return the unit system of the page."""
    return tests[0].units if tests else "si"


def _static(view: TestView, branch: str, index: int, factor: float) -> Trace:
    strain, modulus = view.array("interval_strain"), view.array("interval_modulus")
    own = view.array("interval_branch")
    if strain is None or modulus is None or own is None:
        return line(np.empty(0), np.empty(0), name=view.id, colour=colour(index))
    chosen = (own == BRANCH_VALUES[branch]) & np.isfinite(modulus)
    half = np.nan_to_num(expanded_of(view, "interval_modulus", modulus).half[chosen] * factor)
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plot_text(f"{view.id} (static)"),
        "x": plain_numbers(100.0 * strain[chosen]),
        "y": plain_numbers(modulus[chosen] * factor),
        "error_y": {"type": "data", "array": plain_numbers(half), "width": 4},
        "marker": {**marker(index, size=11), "line": {"width": 1, "color": "#8C8C8C"}},
    }


def _has_curve(view: TestView, specimen: str) -> bool:
    return "tangent_modulus" in view.data and specimen in view.specimens


def _curves(view: TestView, specimen: str, index: int) -> list[Trace]:
    """Return the branches of one specimen of a test, each with its band."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None or specimen not in view.specimens:
        return []
    unit = shown("stress", view.units)
    x = strain * shown("strain", view.units).factor
    row = view.specimens.index(specimen)
    half = expanded_of(view, "tangent_modulus", modulus).half[row] * unit.factor
    mean = modulus[row] * unit.factor
    given = [place for place in range(2) if np.isfinite(mean[place]).any()]
    group = plot_text(view.id)
    found: list[Trace] = []
    for place in given:
        name = view.id if place == given[0] else f"{view.id}, {BRANCH_NAMES[place]}"
        found += [
            band(
                x, mean[place] - half[place], mean[place] + half[place], name=f"{name}: ±",
                colour=colour(index), alpha=0.18, legendgroup=group,
            ),
            line(
                x, mean[place], name=name, colour=colour(index), dash=DASHES[BRANCH_NAMES[place]],
                legendgroup=group, showlegend=place == given[0], **marked(index),
            ),
        ]  # fmt: skip
    return [trace for trace in found if trace["y"]]


def _about_bands(tests: Sequence[TestView]) -> str:
    """Say what the bands of several tests are."""
    name = "tangent_modulus"
    factors = [
        factor
        for view in tests
        for factor in expanded_of(view, name, view.array_like(name, np.zeros(0))).factors
    ]
    return plus_minus_of_tests(factors, tests, [name], mark="Band, ±")


def _modulus_axis(data: Sequence[Trace], units: UnitSystem) -> dict[str, Any]:
    """Return the axis: from zero to all curves, and to nearly all of their bands."""
    title = shown("stress", units).label("tangent modulus")
    lines, ends = heights(data)
    if not lines:
        return axis(title)
    top = max(*lines, float(np.quantile(ends, 0.97)) if ends else 0.0)
    return axis(title, range=plain_numbers(np.array([0.0, 1.08 * top])))
