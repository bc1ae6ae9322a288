"""What stands on a strain grid, and what is fitted to it: variables and values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.reasons import BOUND, CRITERION, NO_YES, OF_UNCERTAINTY, SETTING, SPREAD
from reduction.archive.values import Values, numbers, texts
from reduction.archive.variable import Variable, count, flag, label, measured, stated
from reduction.moduli.product import ElastomerFit, ModulusCurves, Ratio, Segments
from reduction.record import Floats
from reduction.vocabulary import BRANCH_NAMES

_S = ("specimen",)
_B = ("specimen", "branch_name", "strain_bin")
_F = ("specimen", "branch_name", "first_loading_strain_bin")
_BC = ("specimen", "selected_cycle", "branch_name", "strain_bin")
_G = ("specimen", "branch_name", "segment")
_R = ("comparison", "branch_name", "ratio_strain_bin")

CURVE_ROWS: tuple[Variable, ...] = tuple(
    chain(
        stated("strain_window", (), SETTING),
        measured("tangent_modulus", _B, "_count", "_minimum", "_maximum", "_scatter"),
        measured("tangent_modulus_untrimmed", _B),
        measured("branch_tension", _B, "_count"),
        measured("tangent_modulus_by_cycle", _BC),
        measured("tangent_modulus_first_loading", _F),
        measured("branch_tension_first_loading", _F),
        measured("segment_modulus", _G),
        stated("segment_strain_low", _G, BOUND),
        stated("segment_strain_high", _G, BOUND),
        measured("segment_tension_low", _G),
        measured("segment_tension_high", _G),
        stated("segment_misfit", _G, SPREAD),
        label("segment_criterion"),
        measured("stress_at_strain", ("specimen", "strain_level")),
        measured("slack_strain_at_unloading", _S),
        # the ratio of two specimens
        label("ratio_numerator", ("comparison",)),
        label("ratio_denominator", ("comparison",)),
        measured("modulus_ratio", _R),
        stated("modulus_ratio_low", _R, BOUND),
        stated("modulus_ratio_high", _R, BOUND),
        stated("modulus_ratio_degrees_of_freedom", _R, OF_UNCERTAINTY),
        flag("modulus_ratio_is_different", _R, NO_YES),
    )
)
ELASTOMER_ROWS: tuple[Variable, ...] = tuple(
    chain(
        label("elastomer_specimen", ("elastomer_fit",)),
        label("elastomer_law", ("elastomer_fit",)),
        stated("elastomer_rms_stress", ("elastomer_fit",), SPREAD),
        stated("elastomer_strain_low", ("elastomer_fit",), BOUND),
        stated("elastomer_strain_high", ("elastomer_fit",), BOUND),
        flag("elastomer_is_stable", ("elastomer_fit",), NO_YES),
        stated("elastomer_aicc", ("elastomer_fit",), CRITERION),
        count("elastomer_parameter_fit", ("elastomer_parameter",)),
        label("elastomer_parameter_name", ("elastomer_parameter",)),
        measured("elastomer_modulus", ("elastomer_parameter",)),
        measured("elastomer_exponent", ("elastomer_parameter",)),
    )
)


def curve_values(curves: ModulusCurves) -> Values:
    """Return the tangent modulus curves with their companions."""
    values: Values = {
        item.name: getattr(curves, item.name)
        for item in fields(curves)
        if item.name not in ("window", "notes", "branch_tension_count")
    }
    if curves.branch_tension_count is not None:
        values["branch_tension_count"] = curves.branch_tension_count
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
        "modulus_ratio_degrees_of_freedom": np.stack(
            [np.broadcast_to(one.degrees_of_freedom, one.ratio.shape) for one in ratios]
        ),
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
