"""What stands on a strain grid, and what is fitted to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.values import Values, numbers, texts
from reduction.moduli.product import ElastomerFit, ModulusCurves, Ratio, Segments
from reduction.record import Floats
from reduction.vocabulary import BRANCH_NAMES

__all__ = [
    "curve_values",
    "elastomer_values",
    "first_loading_values",
    "ratio_values",
    "segment_values",
    "stress_at_strain_values",
]


def curve_values(curves: ModulusCurves) -> Values:
    """Return the tangent modulus curves with their companions."""
    values: Values = {
        item.name: getattr(curves, item.name)
        for item in fields(curves)
        if item.name not in ("window", "notes")
    }
    return values | {
        "branch_name": texts(BRANCH_NAMES),
        "strain_window": np.array(curves.window),
    }


def first_loading_values(curves: ModulusCurves) -> Values:
    """Return the curves of the first loading, on a strain axis of their own."""
    return {
        "branch_name": texts(BRANCH_NAMES),
        "first_loading_strain_bin": curves.strain_bin,
        "first_loading_strain_bin_bounds": curves.strain_bin_bounds,
        "tangent_modulus_first_loading": curves.tangent_modulus,
        "tangent_modulus_first_loading_standard_uncertainty": (
            curves.tangent_modulus_standard_uncertainty
        ),
        "branch_tension_first_loading": curves.branch_tension,
        "branch_tension_first_loading_standard_uncertainty": (
            curves.branch_tension_standard_uncertainty
        ),
    }


def segment_values(segments: Segments) -> Values:
    """Return the piecewise-linear moduli."""
    values: Values = {
        item.name: getattr(segments, item.name)
        for item in fields(segments)
        if item.name != "criterion"
    }
    return values | {
        "branch_name": texts(BRANCH_NAMES),
        "segment": np.arange(1, segments.segment_modulus.shape[-1] + 1),
        "segment_criterion": np.array(segments.criterion),
    }


def ratio_values(ratios: Sequence[Ratio]) -> Values:
    """Return the modulus ratios of a test, which share one strain grid."""

    def stacked(name: str) -> NDArray[Any]:
        return np.stack([getattr(ratio, name) for ratio in ratios])

    return {
        "branch_name": texts(BRANCH_NAMES),
        "ratio_numerator": texts([ratio.numerator for ratio in ratios]),
        "ratio_denominator": texts([ratio.denominator for ratio in ratios]),
        "ratio_strain_bin": ratios[0].strain_bin,
        "modulus_ratio": stacked("ratio"),
        "modulus_ratio_standard_uncertainty": stacked("ratio_standard_uncertainty"),
        "modulus_ratio_low": stacked("ratio_low"),
        "modulus_ratio_high": stacked("ratio_high"),
        "modulus_ratio_is_different": stacked("is_different"),
    }


def stress_at_strain_values(stress: Floats, uncertainty: Floats, levels: Sequence[float]) -> Values:
    """Return the stress at stated elongations, in rising order of elongation."""
    order = np.argsort(np.asarray(levels, dtype=np.float64), kind="stable")
    return {
        "strain_level": np.asarray(levels, dtype=np.float64)[order],
        "stress_at_strain": stress[..., order],
        "stress_at_strain_standard_uncertainty": uncertainty[..., order],
    }


def elastomer_values(fits: Sequence[ElastomerFit]) -> Values:
    """Return the fitted laws; their parameters are one row each, a modulus or an exponent."""
    rows = [
        (number, name, value, fit.standard_uncertainty.get(name))
        for number, fit in enumerate(fits, start=1)
        for name, value in fit.parameters.items()
    ]
    is_exponent = ["exponent" in name for _, name, _, _ in rows]
    values: Values = {
        "elastomer_specimen": texts([fit.specimen for fit in fits]),
        "elastomer_law": texts([fit.law for fit in fits]),
        "elastomer_rms_stress": numbers([fit.rms_stress for fit in fits]),
        "elastomer_strain_low": numbers([fit.strain_low for fit in fits]),
        "elastomer_strain_high": numbers([fit.strain_high for fit in fits]),
        "elastomer_is_stable": np.array([fit.is_stable for fit in fits], dtype=bool),
        "elastomer_aicc": numbers([fit.aicc for fit in fits]),
        "elastomer_parameter_fit": np.array([row[0] for row in rows], dtype=np.int32),
        "elastomer_parameter_name": texts([row[1] for row in rows]),
    }
    for name, wanted in (("elastomer_modulus", False), ("elastomer_exponent", True)):
        chosen = [exponent is wanted for exponent in is_exponent]
        if any(chosen):
            value = numbers([row[2] for row in rows])
            uncertainty = numbers([row[3] for row in rows])
            values[name] = np.where(chosen, value, np.nan)
            values[f"{name}_standard_uncertainty"] = np.where(chosen, uncertainty, np.nan)
    return values
