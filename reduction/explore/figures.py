"""Figures of a change: where the windows lie, and the curve before and after."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from reduction.record import Bools, Floats
from reduction.report.decimate import POINTS, keep_extremes, with_gaps
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
from reduction.report.figures.holds import draw_holds
from reduction.report.figures.loops import draw_loops
from reduction.report.figures.pull import draw_pull
from reduction.report.figures.record import draw_record, position_of
from reduction.report.figures.stepwise import draw_steps
from reduction.report.style import COLOURS, DASHES, shown
from reduction.report.uncertainty import expanded_of
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_NAMES

__all__ = ["draw_change"]

_OLD = "#8C8C8C"
_KEPT = "#009E73"
_TINTS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def draw_change(
    before: TestView | None, after: TestView | None, *, left_out: tuple[int, int]
) -> list[Figure]:
    """Draw what a change does to a test.

    Parameters
    ----------
    before, after : TestView or None
        As campaign.toml is, and as it would be; None where the test cannot be reduced so.
    left_out : tuple of int
        First cycles that are left out of every mean, before and after the change.

    Returns
    -------
    figures : list of Figure
        Those that the test has something for.
    """
    view = after or before
    if view is None:
        return []
    return [
        *_moduli(before, after),
        *_differences(before, after),
        *_one_cycle(before, after, left_out),
        *(_with_windows(one, view, left_out[1]) for one in draw_record(view)),
        *draw_loops(view),
        *draw_pull(view),
        *draw_holds(view),
        *draw_steps(view),
    ]


def _curves(view: TestView | None, specimen: str) -> tuple[Floats, Floats, Floats] | None:
    """Strain, mean modulus and its expanded uncertainty of a specimen: branch by bin."""
    if view is None or specimen not in view.specimens:
        return None
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None:
        return None
    index = view.specimens.index(specimen)
    half = expanded_of(view, "tangent_modulus", modulus).half
    return strain, modulus[index], half[index]


def _moduli(before: TestView | None, after: TestView | None) -> list[Figure]:
    view = after or before
    if view is None:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        old, new = _curves(before, specimen), _curves(after, specimen)
        for place, branch in enumerate(BRANCH_NAMES):
            if old is not None and before is not after:
                strain, mean, _ = old
                data.append(
                    line(
                        strain * in_strain.factor, mean[place] * in_stress.factor,
                        name=f"{branch}, as it is", colour=_OLD, dash=DASHES[branch], width=4.5,
                        opacity=0.55,
                    )
                )  # fmt: skip
            if new is not None:
                strain, mean, half = (one * 1.0 for one in new)
                x, y = strain * in_strain.factor, mean[place] * in_stress.factor
                spread = half[place] * in_stress.factor
                data.append(
                    band(
                        x, y - spread, y + spread, name=f"{branch}: ±", colour=_TINTS[branch],
                        alpha=0.2, legendgroup=branch,
                    )
                )  # fmt: skip
                data.append(
                    line(
                        x, y, name=f"{branch}, changed" if before is not after else branch,
                        colour=_TINTS[branch], dash=DASHES[branch], width=1.8, legendgroup=branch,
                    )
                )  # fmt: skip
        if data:
            found.append(
                make_figure(
                    f"modulus-{index}", f"{view.id}: modulus, {specimen}",
                    "Tangent modulus against strain, mean over the cycles, ends trimmed. Grey:"
                    " as campaign.toml is. Band: expanded uncertainty, 95 %.",
                    data, synthetic=view.is_synthetic, height=380,
                    xaxis=axis(in_strain.label("strain")),
                    yaxis=axis(in_stress.label("tangent modulus")),
                )
            )  # fmt: skip
    return found


def _differences(before: TestView | None, after: TestView | None) -> list[Figure]:
    if before is None or after is None or before is after:
        return []
    in_strain = shown("strain", after.units)
    found = []
    for index, specimen in enumerate(after.specimens):
        old, new = _curves(before, specimen), _curves(after, specimen)
        if old is None or new is None:
            continue
        data: list[Trace] = []
        for place, branch in enumerate(BRANCH_NAMES):
            known = np.isfinite(old[1][place])
            if known.sum() < 2:
                continue
            x = new[0] * in_strain.factor
            there = np.interp(new[0], old[0][known], old[1][place][known], np.nan, np.nan)
            half = np.interp(new[0], old[0][known], old[2][place][known], np.nan, np.nan)
            share = 100 * half / there
            data += [
                band(
                    x, -share, share, name=f"{branch}: U as it is", colour=_TINTS[branch],
                    alpha=0.12,
                ),
                line(
                    x, 100 * (new[1][place] / there - 1), name=branch, colour=_TINTS[branch],
                    dash=DASHES[branch],
                ),
            ]  # fmt: skip
        if data:
            found.append(
                make_figure(
                    f"difference-{index}", f"{after.id}: change of modulus, {specimen}",
                    "Changed over as it is, less one. Band: expanded uncertainty of the modulus"
                    " as it is, which both share for the most part.",
                    data, synthetic=after.is_synthetic, height=380,
                    xaxis=axis(in_strain.label("strain")), yaxis=axis("difference [%]"),
                )
            )  # fmt: skip
    return found


def _one_cycle(
    before: TestView | None, after: TestView | None, left_out: tuple[int, int]
) -> list[Figure]:
    """The cycle in the middle, with the part of its branches that enters the means."""
    view = after or before
    if view is None or view.n_cycles == 0:
        return []
    time, number = view.array("time"), view.array("cycle_number")
    channel = _control_of(view)
    if time is None or number is None or channel is None:
        return []
    label, values = channel
    cycle = view.stored_near(np.array([(view.n_cycles + 1) // 2], dtype=np.float64))[0]
    own = np.flatnonzero(number == cycle)
    if own.size == 0:
        return []
    first, last = float(time[own[0]]), float(time[own[-1]])
    some = own[keep_extremes(time[own], values[own], limit=POINTS)]
    data = [line(time[some], values[some], name="cycle", colour=_OLD, width=1.0, x_digits=9)]
    parts: list[tuple[str, TestView | None, int, str, float, float]]
    parts = [("in the means", view, left_out[1], _KEPT, 3.0, 1.0)]
    if before is not after:
        parts = [
            ("in the means, as it is", before, left_out[0], "#E69F00", 9.0, 0.6),
            ("in the means, changed", after, left_out[1], _KEPT, 3.0, 1.0),
        ]
    for name, one, out, tint, width, opacity in parts:
        if one is not None:
            data += _kept_between(one, first, last, out, name, tint, width, opacity)
    unit = shown("time", view.units)
    return [
        make_figure(
            "cycle", f"{view.id}: trim of cycle {cycle:.0f}",
            "The cycle in the middle of the test. Thick: the samples at a constant rate, which are"
            f" what enters the means. {_cut_off(before, after)}",
            data, synthetic=view.is_synthetic, height=320, is_wide=True,
            xaxis=axis(unit.label("time")), yaxis=axis(label),
        )
    ]  # fmt: skip


def _cut_off(before: TestView | None, after: TestView | None) -> str:
    """Say how much of the branches of all cycles is cut off."""
    said = []
    for words, view in (("as it is", before), ("changed", after)):
        kept = (
            None if view is None or (view is before and words == "changed") else _in_means(view, 0)
        )
        branch = None if view is None else view.array("branch")
        if kept is not None and branch is not None and (branch > 0).any():
            said.append(f"{100 * (1 - kept.sum() / (branch > 0).sum()):.2g} % {words}")
    return (
        f"Of the samples of all branches, cut off at the ends: {', '.join(said)}." if said else ""
    )


def _control_of(view: TestView) -> tuple[str, Floats] | None:
    """Label and values, as shown, of the channel on which reversals are found."""
    position, tension = position_of(view), view.array("tension")
    if view.attribute("control") == "load" or position is None:
        if tension is None:
            return None
        force = shown("tension", view.units)
        return force.label("tension, mean of the specimens"), tension.mean(axis=0) * force.factor
    length = shown("length", view.units)
    return length.label(position[0]), position[1] * length.factor


def _kept_between(
    view: TestView, first: float, last: float, left_out: int, name: str, tint: str, width: float,
    opacity: float,
) -> list[Trace]:  # fmt: skip
    """Samples between two times that enter the means, a gap between windows."""
    kept, time, channel = _in_means(view, left_out), view.array("time"), _control_of(view)
    if kept is None or time is None or channel is None:
        return []
    own = np.flatnonzero(kept & (time >= first) & (time <= last))
    if own.size == 0:
        return []
    window = np.cumsum(np.diff(own, prepend=own[0]) > 1, dtype=np.int64)
    some = keep_extremes(time[own], channel[1][own], limit=POINTS)
    x, y = with_gaps(window[some], time[own][some], channel[1][own][some])
    return [line(x, y, name=name, colour=tint, width=width, opacity=opacity, x_digits=9)]


def _with_windows(figure: Figure, view: TestView, left_out: int) -> Figure:
    """The record with the samples that enter the means, on the line of position."""
    kept, position = _in_means(view, left_out), position_of(view)
    time = view.array("time")
    if kept is None or position is None or time is None or not kept.any():
        return figure
    own: NDArray[np.intp] = np.flatnonzero(kept)
    values = position[1] * shown("length", view.units).factor
    some = own[keep_extremes(time[own], values[own], limit=2 * POINTS)]
    # a window ends where a sample between two is not in it
    window = np.cumsum(np.diff(own, prepend=own[0]) > 1, dtype=np.int64)
    of_some = window[np.searchsorted(own, some)]
    in_hours = figure.layout["xaxis"]["title"]["text"].endswith("[h]")
    x, y = with_gaps(of_some, time[some] / (3600.0 if in_hours else 1.0), values[some])
    windows = line(x, y, name="in the means", colour=_KEPT, width=3.0, yaxis="y2", x_digits=9)
    return replace(
        figure,
        data=[*figure.data, windows],
        caption=f"{figure.caption} Thick: the windows, which are what enters the means.",
    )


def _in_means(view: TestView, left_out: int) -> Bools | None:
    """Samples at constant rate, in cycles that are not left out."""
    branch, number = view.array("branch"), view.array("cycle_number")
    flags = view.array("crosshead_position_quality_flag")
    if branch is None or number is None or flags is None:
        return None
    mask = view.flag_meanings("crosshead_position_quality_flag").get("not_constant_rate", 0)
    is_off = (flags.astype(np.int64) & mask) != 0
    return np.asarray((branch > 0) & (number > left_out) & ~is_off)
