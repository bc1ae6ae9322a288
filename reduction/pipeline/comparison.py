"""The specimens of one test against the first, and what makes them unequal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reduction.moduli.compare import compare_curves
from reduction.moduli.product import ModulusCurves, Ratio
from reduction.product import History
from reduction.record import Specimen

_SAME_STRAIN = 0.05  # share by which equal greatest strains may differ: one crosshead, two splices


def compare_specimens(
    curves: ModulusCurves, specimens: tuple[Specimen, ...], history: History | None
) -> list[Ratio]:
    """Modulus of each specimen over that of the first, with notes on what they had seen.

    Used against new, where the campaign names new first.
    """
    first = specimens[0]
    ratios = []
    for index, specimen in enumerate(specimens[1:], start=1):
        ratio = compare_curves(
            curves, curves, numerator_specimen=index, denominator_specimen=0,
            numerator_name=specimen.name, denominator_name=first.name,
        )  # fmt: skip
        remarks = ["two specimens in one test, under one crosshead: one piece of each"]
        remarks += _unequal(first, specimen, index, history)
        pair = f"{specimen.name} over {first.name}"
        notes = tuple(f"{pair}: {text}" for text in remarks)
        ratios.append(replace(ratio, notes=(*ratio.notes, *notes)))
    return ratios


def _unequal(first: Specimen, other: Specimen, index: int, history: History | None) -> list[str]:
    """Every way in which two specimens are known to come from unequal histories."""
    found = []
    if first.condition != other.condition:
        told = " against ".join(
            f"'{one.condition}'" if one.condition else "not stated" for one in (other, first)
        )
        found.append(f"unequal before the campaign: condition {told}")
    if history is None:
        return [*found, "what earlier tests did to either is not known: no order is given"]
    cycles, strain = history.earlier_cycles[[index, 0]], history.earlier_maximum_strain[[index, 0]]
    if np.isnan(cycles).any():
        return [*found, "what earlier tests did to them is not wholly known: one of those failed"]
    if cycles[0] != cycles[1]:
        found.append(
            f"unequal histories in the campaign: {cycles[0]:.0f} earlier cycles against "
            f"{cycles[1]:.0f}"
        )
    if history.earlier_flex_cycles is not None:
        flex = history.earlier_flex_cycles[[index, 0]]
        if not np.array_equal(flex[:1], flex[1:], equal_nan=True):
            told = " against ".join("not known" if np.isnan(n) else f"{n:.0f}" for n in flex)
            found.append(f"unequal histories in the campaign: {told} earlier flex cycles")
    is_known = np.isfinite(strain)
    if is_known[0] != is_known[1] or np.ptp(strain) > _SAME_STRAIN * np.max(strain):
        told = " against ".join(
            f"{value:.0%}" if known else "none known"
            for value, known in zip(strain, is_known, strict=True)
        )
        softer = "; rubber is softer below what it has seen" if other.is_rubber else ""
        found.append(f"unequal histories in the campaign: greatest earlier strain {told}{softer}")
    return found
