"""Modulus against strain, ascending and descending, with what is scatter and what is not."""

from __future__ import annotations

import numpy as np

from reduction.archive.freedom import random_freedom
from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
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

__all__ = ["BRANCH_COLOURS", "draw_cycle_curves", "draw_moduli"]

BRANCH_COLOURS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def draw_moduli(view: TestView) -> list[Figure]:
    """Draw one figure a specimen: mean with bands, untrimmed and first loading beside.

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
                    x, parts["untrimmed"][own], name=f"{branch}, ends not trimmed", colour=tint,
                    dash=DASHES[branch], width=1.0, opacity=0.5,
                ),
                line(
                    x, mean, name=branch, colour=tint, dash=DASHES[branch], width=2.2,
                    legendgroup=branch,
                ),
            ]  # fmt: skip
            data += _first_loading(view, own, branch, in_strain, in_stress)
        found.append(
            make_figure(
                f"{view.key}-modulus-{index}",
                f"{view.id}: modulus, {specimen}",
                "Tangent modulus against strain, mean over the cycles. Thin lines: the branches"
                f" with their ends, where the rate is not constant. {about}",
                [trace for trace in data if trace["y"]],
                synthetic=view.is_synthetic,
                height=400,
                xaxis=axis(in_strain.label("strain")),
                yaxis=_modulus_axis(modulus, parts["maximum"], in_stress),
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


def _modulus_axis(mean: Floats, most: Floats, in_stress: Shown) -> dict[str, object]:
    """Return one axis for all specimens, scaled to what is trusted.

    An untrimmed end may run off the top.
    """
    trusted = np.concatenate([mean.ravel(), most.ravel()])
    top = float(np.nanmax(trusted)) if np.isfinite(trusted).any() else 0.0
    title = in_stress.label("tangent modulus")
    return axis(title, range=[0.0, 1.25 * top]) if top > 0 else axis(title)
