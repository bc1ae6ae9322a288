"""Modulus against strain, ascending and descending, with what is scatter and what is not."""

from __future__ import annotations

import numpy as np

from reduction.archive.freedom import random_freedom
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
from reduction.report.style import COLOURS, DASHES, Shown, shown
from reduction.report.uncertainty import (
    NORMAL,
    Expanded,
    expand,
    expanded_of,
    factor_words,
    plus_minus,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_NAMES

BRANCH_COLOURS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def draw_moduli(view: TestView) -> list[Figure]:
    """Draw one figure a specimen: mean with bands, trimmed ends and first loading beside.

    The inner band is what scatter alone leaves open, the outer one all that is known; least and
    greatest cycle are drawn by a click on their entry in the legend.
    """
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    parts = {
        name: view.array_like(f"tangent_modulus_{name}", modulus) * in_stress.factor
        for name in ("minimum", "maximum", "untrimmed")
    }
    everything = expanded_of(view, "tangent_modulus", modulus)
    scatter = _scatter_of(view, modulus)
    about = _about_bands(view, scatter, everything)
    parts |= {
        "all": everything.half * in_stress.factor, "scatter": scatter.half * in_stress.factor,
    }  # fmt: skip
    modulus = modulus * in_stress.factor
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
            own = (index, place)
            tint = BRANCH_COLOURS[branch]
            mean = modulus[own]
            data += [
                band(
                    x, parts["minimum"][own], parts["maximum"][own], colour=tint, alpha=0.13,
                    name=f"{branch}: least to greatest", showlegend=True, visible="legendonly",
                ),
                *(
                    band(
                        x, mean - parts[kind][own], mean + parts[kind][own], colour=tint,
                        alpha=alpha, name=f"{branch}: mean ± {kind}", legendgroup=branch,
                    )
                    for kind, alpha in (("all", 0.2), ("scatter", 0.4))
                ),
                line(
                    x, mean, name=branch, colour=tint, dash=DASHES[branch], width=2.2,
                    legendgroup=branch,
                ),
                line(
                    x, _trimmed_ends(mean, parts["untrimmed"][own]),
                    name=f"{branch}, trimmed away", colour=tint, dash="dot", width=1.3,
                    mode="lines+markers",
                    marker={"symbol": "x-thin-open", "size": 6, "color": tint},
                ),
            ]  # fmt: skip
            data += _first_loading(view, own, branch, in_strain, in_stress)
        found.append(
            make_figure(
                f"{view.key}-modulus-{index}",
                f"{view.id}: modulus, {specimen}",
                "Tangent modulus against strain, mean over the cycles. Dotted with crosses: what"
                " was trimmed away at the ends of a branch, where the rate is not constant; no"
                f" number is taken from there. {about}",
                [trace for trace in data if any(value is not None for value in trace["y"])],
                synthetic=view.is_synthetic,
                height=400,
                xaxis=axis(in_strain.label("strain")),
                yaxis=_modulus_axis(modulus, modulus + parts["all"], in_stress),
            )
        )
    return found


def draw_cycle_curves(view: TestView) -> list[Figure]:
    """Draw the modulus of the first and the last kept cycle, one figure a specimen."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus_by_cycle")
    cycles = view.array("selected_cycle")
    if strain is None or modulus is None or cycles is None or cycles.size < 2:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    spread = expanded_of(view, "tangent_modulus_by_cycle", modulus).half
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for order, kept in enumerate((0, cycles.size - 1)):
            tint = COLOURS[order]
            for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
                mean = modulus[index, kept, place] * in_stress.factor
                half = spread[index, kept, place] * in_stress.factor
                words = f"cycle {cycles[kept]:.0f}, {branch}"
                of = {"cycle": int(cycles[kept])}
                data += [
                    band(x, mean - half, mean + half, name=words, colour=tint, alpha=0.25, meta=of),
                    line(x, mean, name=words, colour=tint, dash=DASHES[branch], meta=of),
                ]
        found.append(
            make_figure(
                f"{view.key}-first-last-{index}", f"{view.id}: first and last cycle, {specimen}",
                "Tangent modulus of the first and of the last cycle, ascending solid,"
                f" descending dashed. {_about_cycles(view)}",
                [trace for trace in data if trace["y"]], synthetic=view.is_synthetic,
                xaxis=axis(in_strain.label("strain")),
                yaxis=axis(in_stress.label("tangent modulus"), rangemode="tozero"),
            )
        )  # fmt: skip
    return found


def _scatter_of(view: TestView, modulus: Floats) -> Expanded:
    """Return the expanded uncertainty of the scatter alone."""
    name = "tangent_modulus"
    both = view.array_like(f"{name}_standard_uncertainty", modulus)
    random = view.array(f"{name}_random_standard_uncertainty")
    return expand(
        both if random is None else random, degrees_of_freedom=random_freedom(view.data, name)
    )


def _about_bands(view: TestView, scatter: Expanded, everything: Expanded) -> str:
    """Say what the bands are; they are one where nothing but scatter is known."""
    name = "tangent_modulus"
    if not shared_sources([view], [name]):
        return plus_minus_of_tests(everything.factors, [view], [name], mark="Band, ±")
    held = f"scatter between cycles, noise, regression alone ({factor_words(scatter.factors)})"
    outer = plus_minus_of_tests(everything.factors, [view], [name], mark="outer band, ±")
    return f"Inner band: {held}; {outer}"


def _about_cycles(view: TestView) -> str:
    """Say what the band of a single cycle is."""
    if not shared_sources([view], ["tangent_modulus"]):
        return plus_minus([NORMAL], "noise, regression", mark="Band, ±")
    held = "noise, regression; and what all samples share, which moves both cycles alike"
    return plus_minus([NORMAL], held, left_out="", mark="Band, ±")


def _trimmed_ends(trimmed: Floats, whole: Floats) -> Floats:
    """Return the whole curve where the trimmed one has no value, and one bin into it to join on."""
    is_left = np.isfinite(trimmed)
    is_next = np.zeros_like(is_left)
    is_next[1:] |= ~is_left[:-1] & np.isfinite(whole[:-1])
    is_next[:-1] |= ~is_left[1:] & np.isfinite(whole[1:])
    return np.where(~is_left | is_next, whole, np.nan)


def _first_loading(
    view: TestView, own: tuple[int, int], branch: str, in_strain: Shown, in_stress: Shown
) -> list[Trace]:
    strain = view.array("first_loading_strain_bin")
    modulus = view.array("tangent_modulus_first_loading")
    if strain is None or modulus is None or not np.isfinite(modulus[own]).any():
        return []
    return [
        line(
            strain * in_strain.factor, modulus[own] * in_stress.factor,
            name=f"first loading, {branch}", colour=COLOURS[2], dash="dot", width=1.4,
            visible="legendonly",
        )
    ]  # fmt: skip


def _modulus_axis(mean: Floats, upper: Floats, in_stress: Shown) -> dict[str, object]:
    """Return one axis for all specimens, scaled to what is trusted.

    An end that was trimmed away may run off the top, and so may the band of a bin that few
    cycles reach.
    """
    title = in_stress.label("tangent modulus")
    if not np.isfinite(mean).any():
        return axis(title)
    usual = np.quantile(upper[np.isfinite(upper)], 0.97) if np.isfinite(upper).any() else 0.0
    return axis(title, range=plain_numbers(1.15 * np.array([0.0, max(np.nanmax(mean), usual)])))
