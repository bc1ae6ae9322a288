"""Loops: stress against strain of the first, the middle and the last cycle."""

from __future__ import annotations

import numpy as np

from reduction.report.decimate import POINTS, keep_extremes
from reduction.report.figure import Figure, Trace, axis, line, make_figure
from reduction.report.style import COLOURS, DASHES, shown
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_VALUES

__all__ = ["draw_loops"]


def draw_loops(view: TestView) -> list[Figure]:
    """Draw one figure a specimen; stress where an area is known, else tension."""
    strain, number, branch = view.array("strain"), view.array("cycle_number"), view.array("branch")
    if strain is None or number is None or branch is None or view.n_cycles == 0:
        return []
    load, words, in_load = (
        view.array("nominal_stress"),
        "nominal stress",
        shown("stress", view.units),
    )
    if load is None or not np.isfinite(load).any():
        load, words, in_load = view.array("tension"), "tension", shown("tension", view.units)
    if load is None:
        return []
    in_strain = shown("strain", view.units)
    # the number on the samples, not the coordinate: a selection of cycles is still right
    wanted = np.array([1, (view.n_cycles + 1) // 2, view.n_cycles], dtype=np.float64)
    cycles = view.stored_near(wanted).astype(int)
    of_stored = "" if view.is_whole else " of those whose samples are stored"
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for order, cycle in enumerate(cycles):
            for name, value in BRANCH_VALUES.items():
                if value == 0:
                    continue
                own = np.flatnonzero((number == cycle) & (branch == value))
                if own.size == 0:
                    continue
                kept = own[
                    keep_extremes(
                        own.astype(np.float64), strain[index, own], load[index, own],
                        limit=POINTS // 4,
                    )
                ]  # fmt: skip
                data.append(
                    line(
                        strain[index, kept] * in_strain.factor, load[index, kept] * in_load.factor,
                        name=f"cycle {cycle}, {name}", colour=COLOURS[(0, 4, 1)[order]],
                        dash=DASHES[name], width=1.6, legendgroup=f"cycle {cycle}",
                        meta={"cycle": int(cycle)},
                    )
                )  # fmt: skip
        found.append(
            make_figure(
                f"{view.key}-loops-{index}", f"{view.id}: loops, {specimen}",
                f"{words.capitalize()} against strain of the splice-free length, first, middle and"
                f" last cycle{of_stored}; ascending solid, descending dashed.",
                data, synthetic=view.is_synthetic, height=400,
                xaxis=axis(in_strain.label("strain")), yaxis=axis(in_load.label(words)),
            )
        )  # fmt: skip
    return found
