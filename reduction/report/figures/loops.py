"""Loops: stress against strain of the first, the middle and the last cycle."""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.report.decimate import POINTS, keep_extremes
from reduction.report.figure import Figure, Trace, axis, line, make_figure
from reduction.report.style import COLOURS, DASHES, shown
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_VALUES


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
        chord: tuple[float, float] | None = None
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
                x, y = strain[index, kept], load[index, kept]
                chord = chord or _chord(x, y)
                opened = y - (chord[0] * x + chord[1])
                data += [
                    line(
                        x * in_strain.factor, values * in_load.factor,
                        name=f"cycle {cycle}, {name}", colour=COLOURS[(0, 4, 1)[order]],
                        dash=DASHES[name], width=1.6, legendgroup=f"cycle {cycle}",
                        meta={"cycle": int(cycle)}, yaxis=where, showlegend=where == "y2",
                    )
                    for values, where in ((y, "y2"), (opened, "y"))
                ]  # fmt: skip
        found.append(
            make_figure(
                f"{view.key}-loops-{index}", f"{view.id}: loops, {specimen}",
                f"Above: {words} against strain of the splice-free length, first, middle and last"
                f" cycle{of_stored}; ascending solid, descending dashed. Below: the same less one"
                " straight line, that of the first branch from end to end, so that the loops open.",
                data, synthetic=view.is_synthetic, height=520,
                xaxis=axis(in_strain.label("strain"), anchor="y"),
                yaxis=axis(in_load.label("less the line"), domain=[0.0, 0.4], zeroline=True),
                yaxis2=axis(in_load.label(words), domain=[0.48, 1.0]),
            )
        )  # fmt: skip
    return found


def _chord(strain: Floats, load: Floats) -> tuple[float, float]:
    """Return slope and height at zero of the straight line between the ends of a branch."""
    known = np.flatnonzero(np.isfinite(strain) & np.isfinite(load))
    if known.size == 0:
        return 0.0, 0.0
    low, high = known[np.argmin(strain[known])], known[np.argmax(strain[known])]
    width = strain[high] - strain[low]
    slope = float((load[high] - load[low]) / width) if width > 0 else 0.0
    return slope, float(load[low] - slope * strain[low])
