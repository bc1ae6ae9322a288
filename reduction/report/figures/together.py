"""The specimens of a campaign in one figure, each with the envelope of its tests.

The form of Figure 31 of [1]_: modulus against stretch of all tests, new and used together.

References
----------
.. [1] WHOI-2005-10, sec. 4.6 and 5.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
from reduction.report.style import DASHES, Shown, colour, marker, plot_text, shorten, shown
from reduction.report.view import TestView, all_specimens, any_synthetic
from reduction.vocabulary import BRANCH_NAMES

_GRID_POINTS = 400
_MOST_LABELS = 10
_MOST_NAMES = 60


def draw_specimens_together(tests: Sequence[TestView]) -> list[Figure]:
    """Draw the modulus of every cyclic test, a colour a specimen, over the envelope of each.

    A long test and the logs that repeat parts of it stand in figures of their own, and are in this
    one where there is no other.
    """
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
            traces = _curves(view, name, order, is_first=is_first)
            is_first = is_first and not traces
            data += traces
            by_test.setdefault(view.id, []).extend(traces)
    labels = [_label(name, traces) for name, traces in by_test.items() if traces]
    if not any(trace["name"] in map(plot_text, names) for trace in data):
        return []
    left = [view.id for view in curved if view not in chosen]
    rest = f" Not in it: {shorten(', '.join(left), 100)}." if left else ""
    return [
        make_figure(
            "campaign-together", f"Modulus of {shorten(' and '.join(names), 40)}, all tests",
            "Tangent modulus against strain, mean over the cycles of each test; a colour a"
            " specimen, ascending solid, descending dashed. Shaded: least to greatest of all"
            " cycles of both branches, of the tests that reach a strain."
            f"{rest}",
            data, synthetic=any_synthetic(chosen), height=480, is_wide=True,
            annotations=labels if len(labels) <= _MOST_LABELS else [],
            xaxis=axis(in_strain.label("strain")),
            yaxis=axis(in_stress.label("tangent modulus"), rangemode="tozero"),
        )
    ]  # fmt: skip


def _curves(view: TestView, specimen: str, order: int, *, is_first: bool) -> list[Trace]:
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
        strain = view.array("strain_bin")
        low, high = view.array("tangent_modulus_minimum"), view.array("tangent_modulus_maximum")
        if strain is None or low is None or high is None or specimen not in view.specimens:
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
