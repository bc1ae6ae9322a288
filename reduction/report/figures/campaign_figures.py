"""Figures over all tests of a campaign.

The form of Figure 31 of [2]_: modulus against stretch of all tests, new and used together.

References
----------
.. [2] WHOI-2005-10, sec. 4.6 and 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.quantities.flags import BRANCH_VALUES
from reduction.quantities.names import BRANCH_NAMES
from reduction.quantities.units import UnitSystem
from reduction.record.measurement import Floats
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.test_view import (
    NORMAL,
    TestView,
    all_specimens,
    any_synthetic,
    expanded_of,
    factor_words,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    DASHES,
    Shown,
    colour,
    marked,
    marker,
    plot_text,
    shorten,
    shown,
)

_STIFFNESS = "test_apparent_spring_constant"

_CYCLES_OF = ", cycles "
"""Between specimen and cycles, in the name of what a ratio is of."""

_LINE_AT_ONE = {
    "type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": 1.0, "y1": 1.0,
    "line": {"width": 1, "dash": "dot", "color": "#8C8C8C"},
}  # fmt: skip


def draw_ratios(tests: Sequence[TestView]) -> list[Figure]:
    """Draw ratios of moduli: a figure a branch, or one for both where one test alone has them."""
    found: list[Figure] = []
    pairs = dict.fromkeys(pair for view in tests for pair in _compared(view))
    for pair in pairs:
        own = [(index, view) for index, view in enumerate(tests) if pair in _compared(view)]
        both = tuple(range(len(BRANCH_NAMES)))
        for places in [both] if len(own) == 1 else [(place,) for place in both]:
            data = [
                trace
                for index, view in own
                for place in places
                for trace in _ratio(view, pair, place, index, is_alone=len(own) == 1)
            ]
            branches = " and ".join(BRANCH_NAMES[place] for place in places)
            figure = make_figure(
                f"campaign-ratio-{len(found)}",
                _ratio_title(own[0][1] if len(own) == 1 else None, pair, branches),
                f"Tangent modulus of {pair[0]} over that of {pair[1]} at the same strain,"
                f" {branches}{'' if len(own) == 1 else ', each test'}; band: 95 % interval without"
                " errors common to both. They differ where it excludes 1.",
                [trace for trace in data if trace["y"]], synthetic=any_synthetic(tests),
                xaxis=axis("strain [%]"), yaxis=_ratio_axis(data),
                shapes=[_LINE_AT_ONE],
            )  # fmt: skip
            if figure.has_data:
                found.append(figure)
    return found


def _ratio(
    view: TestView, pair: tuple[str, str], place: int, index: int, *, is_alone: bool
) -> list[Trace]:
    """Return the ratio of a branch with its interval; of a test alone a colour is a branch."""
    strain, ratio = view.array("ratio_strain_bin"), view.array("modulus_ratio")
    if strain is None or ratio is None:
        return []
    at, branch = _compared(view).index(pair), BRANCH_NAMES[place]
    low, high = (view.array_like(f"modulus_ratio_{end}", ratio) for end in ("low", "high"))
    x = strain * shown("strain", view.units).factor
    look = place if is_alone else index
    name = branch if is_alone else view.id
    return [
        band(x, low[at, place], high[at, place], name=name, colour=colour(look), alpha=0.2),
        line(
            x, ratio[at, place], name=name, colour=colour(look), dash=DASHES[branch],
            **marked(look),
        ),
    ]  # fmt: skip


def _ratio_title(alone: TestView | None, pair: tuple[str, str], branches: str) -> str:
    """Name what is over what, and the test where only one compares the pair."""
    above, below = (words.partition(_CYCLES_OF) for words in pair)
    if above[1] and above[0] == below[0]:
        what = f"modulus, end over start, {above[0]}"
    else:
        what = f"modulus, {pair[0]} over {pair[1]}"
    return f"{alone.id}: {what}" if alone else f"{what[:1].upper()}{what[1:]}, {branches}"


def _compared(view: TestView) -> list[tuple[str, str]]:
    """What the ratios of a test are between, above and below the line."""
    return list(zip(view.texts("ratio_numerator"), view.texts("ratio_denominator"), strict=True))


def _ratio_axis(data: Sequence[Trace]) -> dict[str, Any]:
    """Return the axis: all ratios, and four fifths of the interval ends."""
    title = "ratio of moduli [1]"
    lines, ends = _heights(data)
    if not lines:
        return axis(title)
    usual = np.quantile(ends, [0.1, 0.9]) if ends else np.ones(2)
    low, high = min(*lines, usual[0], 1.0), max(*lines, usual[1], 1.0)
    room = 0.1 * (high - low) + 0.01
    return axis(title, range=plain_numbers(np.array([low - room, high + room])))


def _heights(data: Sequence[Trace]) -> tuple[list[float], list[float]]:
    """Return what the lines of a figure reach, and the edges of its bands."""
    lines = [y for trace in data if "fill" not in trace for y in trace["y"] if y is not None]
    ends = [y for trace in data if "fill" in trace for y in trace["y"] if y is not None]
    return lines, ends


def draw_all_moduli(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the modulus of every test in one figure a specimen, a colour and a marker a test."""
    found = []
    for order, specimen in enumerate(all_specimens(tests)):
        own = [
            (index, view)
            for index, view in enumerate(tests)
            if "tangent_modulus" in view.data and specimen in view.specimens
        ]
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


_LEAST_LEVELS = 3


def draw_stiffness_levels(tests: Sequence[TestView]) -> list[Figure]:
    """Draw EA of each test of a rope against its mean tension, a colour a frequency."""
    own = [view for view in tests if view.is_rope and view.array(_STIFFNESS) is not None]
    if not own or len(own) != len([view for view in tests if view.array(_STIFFNESS) is not None]):
        return []
    force = shown("tension", own[0].units)
    points: dict[float, list[tuple[float, float, float, str]]] = {}
    for view in own:
        constant = view.array_like(_STIFFNESS, np.full(len(view.specimens), np.nan))
        half = expanded_of(view, _STIFFNESS, constant).half
        tension = view.array_like("test_mean_tension", constant)
        frequency = view.array_like("test_frequency", constant)
        for place in np.flatnonzero(np.isfinite(constant) & np.isfinite(tension)).tolist():
            key = float(f"{frequency[place]:.2g}")
            label = f"{view.id}, {view.specimens[place]}"
            points.setdefault(key, []).append(
                (float(tension[place]), float(constant[place]), float(half[place]), label)
            )
    if sum(map(len, points.values())) < _LEAST_LEVELS:
        return []
    data: list[Trace] = [
        {
            "x": [force.factor * row[0] for row in rows],
            "y": [force.factor * row[1] for row in rows],
            "error_y": {"type": "data", "array": [force.factor * row[2] for row in rows]},
            "text": [plot_text(row[3]) for row in rows],
            "type": "scatter", "mode": "markers", "name": f"{frequency:g} Hz",
            "marker": marker(index, size=8),
        }
        for index, (frequency, rows) in enumerate(sorted(points.items()))
    ]  # fmt: skip
    return [
        make_figure(
            "campaign-stiffness-levels", "EA of the cycles against mean tension",
            "EA of each test: tension amplitude over strain amplitude. One colour per frequency;"
            " bars: 95 % interval.",
            data, synthetic=any_synthetic(own), height=420, is_wide=True,
            xaxis=axis(force.label("mean tension")), yaxis=axis(force.label("EA")),
        )
    ]  # fmt: skip


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
                        f"Mean tangent modulus in the parts of {whole} that were logged"
                        f" separately: the change over the long test. {_about_bands(parts)}",
                        data, synthetic=any_synthetic(parts), height=400,
                        xaxis=axis("strain [%]"),
                        yaxis=_modulus_axis(data, parts[0].units if parts else "si"),
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
    lines, ends = _heights(data)
    if not lines:
        return axis(title)
    top = max(*lines, float(np.quantile(ends, 0.97)) if ends else 0.0)
    return axis(title, range=plain_numbers(np.array([0.0, 1.08 * top])))


_GRID_POINTS = 400

_MOST_LABELS = 10

_MOST_NAMES = 60


def draw_specimens_together(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the modulus of every cyclic test, a colour a specimen, over the envelope of each."""
    curved = [view for view in tests if "tangent_modulus" in view.data]
    own = [view for view in curved if view.kind == "cyclic" and not view.attribute("part_of")]
    chosen = own or curved
    if not chosen:
        return []
    units = chosen[0].units
    in_stress, in_strain = shown("stress", units), shown("strain", units)
    names = all_specimens(chosen)
    if len(chosen) == len(names) == 1:  # nothing to be seen together
        return []
    envelopes = [_envelope(chosen, name, order, in_stress) for order, name in enumerate(names)]
    data = [trace for trace in envelopes if trace is not None]
    by_test: dict[str, list[Trace]] = {}
    for order, name in enumerate(names):
        is_first = True
        for view in chosen:
            if name not in view.specimens:
                continue
            traces = _test_curves(view, name, order, is_first=is_first)
            is_first = is_first and not traces
            data += traces
            by_test.setdefault(view.id, []).extend(traces)
    labels = [_label(name, traces) for name, traces in by_test.items() if traces]
    if not any(trace["name"] in map(plot_text, names) for trace in data):
        return []
    left = [view.id for view in curved if view not in chosen]
    rest = f" Not shown: {shorten(', '.join(left), 100)}." if left else ""
    return [
        make_figure(
            "campaign-together", f"Modulus of {_of_specimens(names)}, all tests",
            "Mean tangent modulus of each test. One colour per specimen; ascending solid,"
            f" descending dashed. Shaded: range over all cycles and both branches.{rest}",
            data, synthetic=any_synthetic(chosen), height=480, is_wide=True,
            annotations=labels if len(labels) <= _MOST_LABELS else [],
            xaxis=axis(in_strain.label("strain")),
            yaxis=axis(in_stress.label("tangent modulus"), rangemode="tozero"),
        )
    ]  # fmt: skip


def _of_specimens(names: Sequence[str]) -> str:
    """Return the names of the specimens, or how many where they need more than a title has.

    Examples
    --------
    >>> _of_specimens(["s0", "s1", "s2"]), _of_specimens(["a" * 30, "b" * 30])
    ('s0, s1 and s2', '2 specimens')
    """
    *others, last = names
    said = f"{', '.join(others)} and {last}" if others else last
    if len(said) <= _TITLE:
        return said
    return f"{len(names)} specimens" if others else shorten(said, _TITLE)


_TITLE = 40


def _test_curves(view: TestView, specimen: str, order: int, *, is_first: bool) -> list[Trace]:
    """Return the branches of one specimen of a test; the first of all stand in the legend."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    row = view.specimens.index(specimen)
    branches = view.texts("branch_name") or BRANCH_NAMES
    found: list[Trace] = []
    for branch in BRANCH_NAMES:
        values = modulus[row, branches.index(branch)]
        if np.isfinite(values).any():
            found.append(
                line(
                    strain * in_strain.factor, values * in_stress.factor, name=specimen,
                    colour=colour(order), dash=DASHES[branch], width=1.6, mode="lines+markers",
                    marker={**marker(order), "maxdisplayed": 4},
                    legendgroup=plot_text(specimen), showlegend=is_first and not found,
                    text=plot_text(f"{view.id}, {branch}"),
                )
            )  # fmt: skip
    return found


def _label(name: str, traces: Sequence[Trace]) -> Trace:
    """Return the name of a test, above the highest of its curves."""
    height, place = max(
        (y, x)
        for trace in traces
        for x, y in zip(trace["x"], trace["y"], strict=True)
        if y is not None
    )
    return {
        "text": plot_text(name, 20), "x": place, "y": height, "showarrow": False,
        "xanchor": "center", "yanchor": "bottom", "yshift": 3, "font": {"size": 11},
    }  # fmt: skip


def _envelope(
    tests: Sequence[TestView], specimen: str, order: int, in_stress: Shown
) -> Trace | None:
    pieces: list[tuple[Floats, Floats, Floats]] = []
    for view in tests:
        if specimen not in view.specimens:
            continue
        strain = view.array("strain_bin")
        low, high = view.array("tangent_modulus_minimum"), view.array("tangent_modulus_maximum")
        if strain is None or low is None or high is None:
            continue
        row = view.specimens.index(specimen)
        for place in range(low.shape[1]):
            used = np.isfinite(low[row, place]) & np.isfinite(high[row, place])
            if used.any():
                pieces.append((strain[used], low[row, place, used], high[row, place, used]))
    if not pieces:
        return None
    # finer than any bin, so that a gap between two tests stays a gap
    first, last = min(one[0][0] for one in pieces), max(one[0][-1] for one in pieces)
    grid = np.linspace(first, last, _GRID_POINTS)
    outside = {"left": np.nan, "right": np.nan}
    least = np.fmin.reduce([np.interp(grid, strain, low, **outside) for strain, low, _ in pieces])
    most = np.fmax.reduce([np.interp(grid, strain, high, **outside) for strain, _, high in pieces])
    percent = shown("strain", tests[0].units)
    least, most = (ends * in_stress.factor for ends in (least, most))
    return band(
        grid * percent.factor, least, most, name=f"{shorten(specimen, _MOST_NAMES)}: envelope",
        colour=colour(order), alpha=0.14, showlegend=True,
    )  # fmt: skip
