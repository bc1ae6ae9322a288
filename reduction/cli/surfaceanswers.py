"""Surfaces and effects as one JSON object: SI, each quantity with its unit beside it."""

from __future__ import annotations

from typing import Any

import numpy as np

from reduction.campaign.runtable import RunSeries
from reduction.cli.numbers import fitted_unit, plain
from reduction.surface.confounding import alias_matrix
from reduction.surface.drift import Drift
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.product import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.surface.screening import ScreeningEffects
from reduction.units import combined_unit


def frame(runs: RunSeries, notes: tuple[str, ...]) -> dict[str, Any]:
    """What answers for surfaces and for effects have in common."""
    return {
        "n_runs": len(runs.row),
        "factors": [
            {"name": name, "unit": unit, "low": low, "high": high}
            for name, unit, low, high in zip(
                runs.factor_names, runs.factor_units, runs.low.tolist(), runs.high.tolist(),
                strict=True,
            )
        ],
        "notes": list(notes),
    }  # fmt: skip


def surface_document(
    surfaces: ResponseSurfaces, index: int, runs: RunSeries, drift: Drift
) -> dict[str, Any]:
    """One response: every number of its surface."""
    anova, lack, canonical = surfaces.anova, surfaces.lack_of_fit, surfaces.canonical
    unit = fitted_unit(runs.response_units[index], surfaces.transform[index])
    lines = zip(
        anova.source, anova.degrees_of_freedom[index], anova.sum_of_squares[index],
        anova.mean_square[index], anova.f[index], anova.p_value[index], anova.error_term,
        strict=True,
    )  # fmt: skip
    reason = int(surfaces.reason[index])
    diagnostics, blocks = surfaces.diagnostics, surfaces.blocks
    return {
        "unit": runs.response_units[index] or None,
        "transform": surfaces.transform[index],
        "transform_exponent": plain(surfaces.transform_exponent[index]),
        "transform_exponent_interval": plain(surfaces.transform_exponent_interval[index]),
        "coefficient_unit": unit or None,
        "labels": list(surfaces.labels),
        "terms": list(surfaces.term_names),
        "coefficient": plain(surfaces.coefficient[index]),
        "standard_error": plain(surfaces.coefficient_standard_uncertainty[index]),
        "t": plain(surfaces.t[index]),
        "p_value": plain(surfaces.p_value[index]),
        "error_term": list(surfaces.error_term),
        "r2": plain(surfaces.r2[index]),
        "adjusted_r2": plain(surfaces.adjusted_r2[index]),
        "predicted_r2": plain(surfaces.predicted_r2[index]),
        "sigma": plain(surfaces.sigma[index]),
        "degrees_of_freedom": int(surfaces.degrees_of_freedom[index]),
        "overall": {
            "f": plain(surfaces.overall_f[index]),
            "p": plain(surfaces.overall_p_value[index]),
            "printed_f": plain(surfaces.printed_f[index]),
        },
        "anova": [
            {
                "source": source, "df": None if np.isnan(df) else int(df), "ss": plain(ss),
                "ms": plain(ms), "f": plain(f), "p": plain(p), "error_term": error_term,
            }
            for source, df, ss, ms, f, p, error_term in lines
        ],
        "lack_of_fit": {
            "df": int(lack.degrees_of_freedom[index]),
            "pure_error_df": int(lack.pure_error_degrees_of_freedom[index]),
            "f": plain(lack.f[index]),
            "p": plain(lack.p_value[index]),
            "reason": LACK_OF_FIT_REASONS[int(lack.reason[index])],
        },
        "stationary_point": {
            "coded": plain(canonical.stationary_point[index]),
            "engineering": plain(canonical.stationary_point_engineering[index]),
            "unit": list(runs.factor_units),
            "coded_standard_error": plain(canonical.stationary_point_standard_uncertainty[index]),
            "value": plain(canonical.stationary_value[index]),
            "kind": STATIONARY_KINDS[int(canonical.kind[index])],
            "inside": bool(canonical.is_inside[index]),
            "reason": STATIONARY_REASONS[int(canonical.reason[index])],
        },
        "eigenvalues": plain(canonical.eigenvalue[index]),
        "eigenvalue_standard_error": plain(canonical.eigenvalue_standard_uncertainty[index]),
        "eigenvectors": plain(canonical.eigenvector[index].T),
        "engineering": {
            "terms": list(surfaces.term_names),
            "coefficient": plain(surfaces.coefficient_engineering[index]),
            "standard_error": plain(surfaces.coefficient_engineering_standard_uncertainty[index]),
            "unit": [
                combined_unit(unit, runs.factor_units, powers.tolist()) if unit else None
                for powers in surfaces.exponents
            ],
        },
        "drift": {
            "per_run": plain(drift.slope[index]),
            "standard_error": plain(drift.standard_uncertainty[index]),
            "p": plain(drift.p_value[index]),
        },
        "blocks": None if blocks is None else {
            "names": list(blocks.names),
            "treatment": blocks.treatment,
            "effect": plain(blocks.effect[index]),
            "standard_deviation": plain(blocks.standard_deviation[index]),
        },
        "runs": {
            "name": list(surfaces.run_names),
            "coded": plain(surfaces.coded),
            "fitted": plain(surfaces.fitted[index]),
            "residual": plain(surfaces.residual[index]),
            "leverage": plain(diagnostics.leverage[index]),
            "cooks_distance": plain(diagnostics.cooks_distance[index]),
            "deleted_residual": plain(diagnostics.deleted_residual[index]),
        },
        "reason": FIT_REASONS[reason],
    }  # fmt: skip


def effects_document(effects: ScreeningEffects, runs: RunSeries) -> dict[str, Any]:
    """Effects of every response, and what they are mixed of."""
    pairs, alias = alias_matrix(np.where(runs.coded < 0, -1.0, 1.0))
    names = effects.names
    documents = {
        name: {
            "unit": runs.response_units[index] or None,
            "terms": list(names),
            "effect": plain(effects.effect[index]),
            "dummy_effect": plain(effects.dummy_effect[index]),
            "mean": plain(effects.mean[index]),
            "standard_error": plain(effects.effect_standard_error[index]),
            "t": plain(effects.t_value[index]),
            "p_value": plain(effects.p_value[index]),
            "minimum_significant_effect": plain(effects.minimum_significant_effect[index]),
            "simultaneous_minimum_effect": plain(effects.simultaneous_minimum_effect[index]),
            "is_significant": plain(effects.is_significant[index]),
            "reason": str(effects.reason[index]),
        }
        for index, name in enumerate(runs.response_names)
    }
    return {
        "fit": "effects",
        "error_from": effects.error_from,
        "degrees_of_freedom": effects.degrees_of_freedom,
        "significance": effects.significance,
        "responses": documents,
        "aliases": {
            name: {
                f"{names[one]}*{names[other]}": value
                for (one, other), value in zip(
                    pairs, alias[place + 1].round(12).tolist(), strict=True
                )
                if value
            }
            for place, name in enumerate(names)
        },
    }
