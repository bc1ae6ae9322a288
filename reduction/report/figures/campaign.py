"""Figures over the tests of a campaign: the forms of Figures 31, 34 and 35 of [1]_.

All moduli in one, ratios of specimens, amplitude pairs, start against end of a long test,
static against dynamic.

References
----------
.. [1] WHOI-2005-10, sec. 4.5 to 4.8.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.record import Floats
from reduction.report.figure import (
    Figure,
    Trace,
    axis,
    band,
    line,
    make_figure,
    plain_numbers,
)
from reduction.report.style import DASHES, colour, marker, plot_text, shown
from reduction.report.view import TestView, all_specimens, any_synthetic
from reduction.units import UnitSystem
from reduction.vocabulary import BRANCH_NAMES, BRANCH_VALUES

GRID_POINTS = 400

__all__ = [
    "draw_all_moduli", "draw_parts", "draw_ratios",
    "draw_static_dynamic",
]  # fmt: skip


def draw_all_moduli(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the modulus of every test in one figure a specimen, with the envelope of all."""
    found = []
    for order, specimen in enumerate(all_specimens(tests)):
        data: list[Trace] = []
        for branch in BRANCH_NAMES:
            envelope = _envelope(tests, specimen, branch)
            if envelope is not None:
                data.append(envelope)
        for index, view in enumerate(tests):
            data += _curves(view, specimen, index)
        if not data:
            continue
        units = tests[0].units
        found.append(
            make_figure(
                f"campaign-moduli-{order}", f"All tests: modulus, {specimen}",
                "Mean tangent modulus of every test against strain; ascending solid, descending"
                " dashed. Shaded: least to greatest of all cycles of all tests, a branch each.",
                data, synthetic=any_synthetic(tests), height=480, is_wide=True,
                xaxis=axis(shown("strain", units).label("strain")),
                yaxis=axis(shown("stress", units).label("tangent modulus"), rangemode="tozero"),
            )
        )  # fmt: skip
    return found


def draw_ratios(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the ratio of the specimens of each test, one figure a branch."""
    found: list[Figure] = []
    pairs = dict.fromkeys(pair for view in tests for pair in _compared(view))
    for pair in pairs:
        for place, branch in enumerate(BRANCH_NAMES):
            data: list[Trace] = []
            for index, view in enumerate(tests):
                strain, ratio = view.array("ratio_strain_bin"), view.array("modulus_ratio")
                if pair not in _compared(view) or strain is None or ratio is None:
                    continue
                at = _compared(view).index(pair)
                low, high = (
                    view.array_like(f"modulus_ratio_{end}", ratio) for end in ("low", "high")
                )
                x = strain * shown("strain", view.units).factor
                data += [
                    band(
                        x,
                        low[at, place],
                        high[at, place],
                        name=view.id,
                        colour=colour(index),
                        alpha=0.2,
                    ),
                    line(
                        x, ratio[at, place], name=view.id, colour=colour(index),
                        dash=DASHES[branch], **_marked(index),
                    ),
                ]  # fmt: skip
            figure = make_figure(
                f"campaign-ratio-{len(found)}",
                f"{_only(tests, pair)}{branch}, {pair[0]} over {pair[1]}",
                f"Tangent modulus of {pair[0]} over that of {pair[1]} at the same strain,"
                f" {branch} branch, each test; band: 95 % interval, of scatter alone. Where it"
                " leaves out 1 the two differ.",
                [trace for trace in data if trace["y"]], synthetic=any_synthetic(tests),
                xaxis=axis("strain [%]"), yaxis=_ratio_axis(data),
                shapes=[_level(1.0)],
            )  # fmt: skip
            if figure.has_data:
                found.append(figure)
    return found


def _only(tests: Sequence[TestView], pair: tuple[str, str]) -> str:
    """Name the test where only one compares the pair: there is no legend then."""
    own = [view.id for view in tests if pair in _compared(view)]
    return f"{own[0]}: " if len(own) == 1 and len(tests) > 1 else ""


def _compared(view: TestView) -> list[tuple[str, str]]:
    """What the ratios of a test are between, above and below the line."""
    return list(zip(view.texts("ratio_numerator"), view.texts("ratio_denominator"), strict=True))


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
                        " what the long test changed.",
                        data, synthetic=any_synthetic(parts), height=400,
                        xaxis=axis("strain [%]"),
                        yaxis=axis(
                            shown("stress", whole_units(parts)).label("tangent modulus"),
                            rangemode="tozero",
                        ),
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
                        width=1.4, **_marked(index, names.index(specimen)),
                    )
                )  # fmt: skip
        for index, view in stepwise:
            data.append(_static(view, branch, index, in_stress.factor))
        found.append(
            make_figure(
                f"campaign-static-{branch}", f"Static against dynamic, {branch}",
                "Interval moduli of the stepwise tests (markers) over the tangent moduli of the"
                f" cyclic tests (lines), {branch}.",
                data, synthetic=any_synthetic(tests), height=420,
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
    return {
        "type": "scatter",
        "mode": "markers",
        "name": plot_text(f"{view.id} (static)"),
        "x": plain_numbers(100.0 * strain[chosen]),
        "y": plain_numbers(modulus[chosen] * factor),
        "marker": {**marker(index, size=11), "line": {"width": 1, "color": "#8C8C8C"}},
    }


def _curves(view: TestView, specimen: str, index: int) -> list[Trace]:
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None or specimen not in view.specimens:
        return []
    unit = shown("stress", view.units)
    row = view.specimens.index(specimen)
    given = [place for place in range(2) if np.isfinite(modulus[row, place]).any()]
    return [
        line(
            100.0 * strain, modulus[row, place] * unit.factor,
            name=view.id if place == given[0] else f"{view.id}, {BRANCH_NAMES[place]}",
            colour=colour(index), dash=DASHES[BRANCH_NAMES[place]],
            legendgroup=plot_text(view.id), showlegend=place == given[0], **_marked(index),
        )
        for place in given
    ]  # fmt: skip


def _marked(index: int, variant: int = 0) -> dict[str, Any]:
    """Return what puts a few markers of a test on its line: colours alone are seven."""
    return {
        "mode": "lines+markers",
        "marker": {**marker(index, variant=variant), "maxdisplayed": 6},
    }


def _envelope(tests: Sequence[TestView], specimen: str, branch: str) -> Trace | None:
    place = BRANCH_NAMES.index(branch)
    lows: list[tuple[Floats, Floats, Floats]] = []
    for view in tests:
        strain = view.array("strain_bin")
        low, high = view.array("tangent_modulus_minimum"), view.array("tangent_modulus_maximum")
        if strain is None or low is None or high is None or specimen not in view.specimens:
            continue
        row = view.specimens.index(specimen)
        used = np.isfinite(low[row, place]) & np.isfinite(high[row, place])
        if used.any():
            lows.append((strain[used], low[row, place, used], high[row, place, used]))
    if not lows:
        return None
    # finer than any bin, so that a gap between two tests stays a gap
    ends = [(strain[0], strain[-1]) for strain, _, _ in lows]
    grid = np.linspace(min(low for low, _ in ends), max(high for _, high in ends), GRID_POINTS)
    outside = {"left": np.nan, "right": np.nan}
    least = np.fmin.reduce([np.interp(grid, strain, low, **outside) for strain, low, _ in lows])
    most = np.fmax.reduce([np.interp(grid, strain, high, **outside) for strain, _, high in lows])
    factor = shown("stress", tests[0].units).factor
    return band(
        100.0 * grid, least * factor, most * factor, name=f"envelope, {branch}",
        colour="#0072B2" if place == 0 else "#D55E00", alpha=0.12, showlegend=True,
    )  # fmt: skip


def _ratio_axis(data: Sequence[Trace]) -> dict[str, Any]:
    """Return the axis: all ratios, and four fifths of the interval ends.

    Where few cycles reach, an interval may be so wide that it would hide the rest.
    """
    title = "ratio of moduli [1]"
    lines = [y for trace in data if "fill" not in trace for y in trace["y"] if y is not None]
    ends = [y for trace in data if "fill" in trace for y in trace["y"] if y is not None]
    if not lines:
        return axis(title)
    usual = np.quantile(ends, [0.1, 0.9]) if ends else np.ones(2)
    low, high = min(*lines, usual[0], 1.0), max(*lines, usual[1], 1.0)
    room = 0.1 * (high - low) + 0.01
    return axis(title, range=plain_numbers(np.array([low - room, high + room])))


def _level(height: float) -> Trace:
    return {
        "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": height, "y1": height,
        "line": {"width": 1, "dash": "dot", "color": "#8C8C8C"},
    }  # fmt: skip
