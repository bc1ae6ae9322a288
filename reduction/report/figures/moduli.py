"""Modulus against strain, ascending and descending, with its uncertainty and its envelope."""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.report.figure import Figure, Trace, axis, band, line, make_figure
from reduction.report.style import COLOURS, DASHES, Shown, shown
from reduction.report.uncertainty import plus_minus
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_NAMES

__all__ = ["BRANCH_COLOURS", "draw_cycle_curves", "draw_moduli"]

BRANCH_COLOURS = {"ascending": COLOURS[0], "descending": COLOURS[1]}


def draw_moduli(view: TestView) -> list[Figure]:
    """Draw one figure a specimen: mean with bands, untrimmed and first loading beside."""
    strain, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if strain is None or modulus is None:
        return []
    in_stress, in_strain = shown("stress", view.units), shown("strain", view.units)
    parts = {
        name: view.array_like(f"tangent_modulus_{name}", modulus) * in_stress.factor
        for name in ("standard_uncertainty", "minimum", "maximum", "untrimmed")
    }
    modulus = modulus * in_stress.factor
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
            own = (index, place)
            tint = BRANCH_COLOURS[branch]
            mean, uncertainty = modulus[own], parts["standard_uncertainty"][own]
            data += [
                band(
                    x, parts["minimum"][own], parts["maximum"][own], colour=tint, alpha=0.13,
                    name=f"{branch}: least to greatest", legendgroup=branch,
                ),
                band(
                    x, mean - uncertainty, mean + uncertainty, colour=tint, alpha=0.35,
                    name=f"{branch}: mean ±", legendgroup=branch,
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
                "Tangent modulus against strain, mean over the cycles. Light"
                " band: least to greatest cycle; thin lines: the branches with their ends,"
                f" where the rate is not constant. {plus_minus(mark='Dark band, ±')}",
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
    uncertainty = view.array_like("tangent_modulus_by_cycle_standard_uncertainty", modulus)
    x = strain * in_strain.factor
    found = []
    for index, specimen in enumerate(view.specimens):
        data: list[Trace] = []
        for order, kept in enumerate((0, cycles.size - 1)):
            tint = COLOURS[order]
            for place, branch in enumerate(view.texts("branch_name") or BRANCH_NAMES):
                mean = modulus[index, kept, place] * in_stress.factor
                half = uncertainty[index, kept, place] * in_stress.factor
                words = f"cycle {cycles[kept]:.0f}, {branch}"
                data += [
                    band(x, mean - half, mean + half, name=words, colour=tint, alpha=0.25),
                    line(x, mean, name=words, colour=tint, dash=DASHES[branch]),
                ]
        found.append(
            make_figure(
                f"{view.key}-first-last-{index}", f"{view.id}: first and last cycle, {specimen}",
                "Tangent modulus of the first and of the last cycle, ascending solid,"
                f" descending dashed. {plus_minus('noise, regression', mark='Band, ±')}",
                [trace for trace in data if trace["y"]], synthetic=view.is_synthetic,
                xaxis=axis(in_strain.label("strain")),
                yaxis=axis(in_stress.label("tangent modulus"), rangemode="tozero"),
            )
        )  # fmt: skip
    return found


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
