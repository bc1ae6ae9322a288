"""What one experiment gives to its archive, by name, without the dimension ``experiment``."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.archive.effects import alias_values, effect_values
from reduction.archive.shared import component_values
from reduction.archive.surface_points import both_parts, point_values, ridge_values
from reduction.archive.values import Values, texts
from reduction.errors import ArchiveError
from reduction.experiment import ExperimentResult, RunTable, SharedSurfaces
from reduction.line.single import VERDICTS, SingleTimeCheck
from reduction.surface.canonicalslopes import canonical_slopes
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.product import LACK_OF_FIT_REASONS, STATIONARY_REASONS, ResponseSurfaces
from reduction.surface.select import ReducedSurfaces
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.units import combined_unit
from reduction.vocabulary import SURFACE_NAMES

_RUN_COLUMNS = (
    "frequency",
    "mean_tension",
    "tension_amplitude",
    "peak_tension",
    "minimum_tension",
    "rated_break_strength",
)
_SINGLE_TIME = {
    "exponent": "exponent",
    "exponent_standard_uncertainty": "exponent_standard_uncertainty",
    "exponent_low": "exponent_low",
    "exponent_high": "exponent_high",
    "p_one_time": "p_value_one_time",
    "p_inverse_frequency": "p_value_inverse_frequency",
    "time_ratio": "ratio",
    "time_ratio_low": "ratio_low",
    "time_ratio_high": "ratio_high",
    "frequency_ratio": "frequency_ratio",
    "degrees_of_freedom": "degrees_of_freedom",
    "loss_exponent": "loss_exponent",
    "loss_exponent_low": "loss_exponent_low",
    "loss_exponent_high": "loss_exponent_high",
    "confidence": "confidence",
    "tolerance": "tolerance",
}
"""Field of the check to name after ``single_time_``."""


def experiment_values(result: ExperimentResult) -> Values:
    """Return every number and text of an experiment but its notes and its stiffness forms.

    Parameters
    ----------
    result : ExperimentResult
        With responses of `reduction.vocabulary.RESPONSES`.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`.

    Raises
    ------
    ArchiveError
        If a response has no name, or the surfaces are of other runs.
    """
    fitted = () if result.surfaces is None else result.surfaces.response_names
    strange = sorted({*result.response_names, *fitted} - set(SURFACE_NAMES))
    if strange:
        raise ArchiveError(
            "a response has no name in the archive",
            found=", ".join(strange),
            needed="a response of reduction.vocabulary, or its transform",
        )
    values: Values = {
        "experiment_kind": np.array(result.kind),
        "factor": np.arange(1, len(result.factor_names) + 1),
        "factor_name": texts(result.factor_names),
        "factor_unit": texts(result.factor_units),
        "factor_low": result.low,
        "factor_high": result.high,
        "derived_dissipation_spring_constant": result.derived_dissipation_spring_constant,
        "derived_relaxation_time": result.derived_relaxation_time,
    }
    values |= _run_values(result.runs, result.response_names)
    n_columns = result.runs.coded_plan.shape[1]
    dummies = [f"dummy {n + 1}" for n in range(n_columns - len(result.factor_names))]
    values |= {
        "plan_column": np.arange(1, n_columns + 1),
        "plan_column_name": texts([*result.factor_names, *dummies]),
    }
    if result.surfaces is not None:
        _require_same_runs(result.runs, result.surfaces)
        values |= _common_values(result.surfaces, result.factor_units)
        if result.shared is not None:
            values |= component_values(result.shared.component)
        for index, name in enumerate(result.surfaces.response_names):
            values |= _surface_values(result.surfaces, index, name)
            if result.shared is not None:
                values |= _with_shared(values, result.surfaces, result.shared, index, name)
            if result.reduced is not None:
                values |= _reduced_values(result.reduced, index, name)
        plan = result.runs.coded_plan[:, : len(result.factor_names)]
        values |= point_values(result.surfaces, plan, result.shared)
        values |= ridge_values(result.surfaces, result.shared)
    if result.screening is not None:
        values |= effect_values(result.screening, result.response_names)
        values |= alias_values(result.runs.coded_plan, result.factor_names)
    if result.single_time is not None:
        values |= _single_time_values(result.single_time)
    return values


def _run_values(runs: RunTable, response_names: Sequence[str]) -> Values:
    values: Values = {
        "run": np.arange(1, len(runs.run) + 1),
        "run_name": texts(runs.run),
        "run_specimen": texts(runs.specimen),
        "run_remark": texts(runs.remark),
        "run_plan": runs.coded_plan,
        "run_level": runs.level,
    }
    values |= {f"run_{name}": getattr(runs, name) for name in _RUN_COLUMNS}
    for index, name in enumerate(response_names):
        values[f"{name}_measured"] = runs.response[index]
        random = runs.response_standard_uncertainty[index]
        values[f"{name}_measured_standard_uncertainty"] = random
        if runs.shared is not None:
            rows = runs.shared.values[name]
            values |= {
                f"{name}_measured_standard_uncertainty": combined_standard_uncertainty(
                    rows, random
                ),
                f"{name}_measured_random_standard_uncertainty": random,
            }
    return values


def _require_same_runs(runs: RunTable, surfaces: ResponseSurfaces) -> None:
    strange = set(surfaces.run_names) ^ set(runs.names)
    if surfaces.run_names != runs.names:
        raise ArchiveError(
            "the runs of the surfaces are not those of the experiment",
            found=", ".join(sorted(strange)) or "another order",
            needed="the runs of the experiment in their order, NaN where one is missing",
        )


def _common_values(surfaces: ResponseSurfaces, factor_units: Sequence[str]) -> Values:
    """What all surfaces of an experiment have in common."""
    values: Values = {
        "term": texts(surfaces.labels),
        "term_other": texts(surfaces.labels),
        "term_name": texts(surfaces.term_names),
        "term_unit_engineering": texts(
            [combined_unit("1", factor_units, powers) for powers in surfaces.exponents]
        ),
        "term_error": texts(surfaces.error_term),
        "term_exponent": surfaces.exponents,
        "direction": np.arange(1, len(surfaces.factor_names) + 1),
        "anova_source": texts(surfaces.anova.source),
        "anova_error_term": texts(surfaces.anova.error_term),
        "replicate_tolerance": np.array(surfaces.lack_of_fit.tolerance),
        "condition_number": np.array(surfaces.condition_number),
        "run_coded_level": surfaces.coded,
        "run_cell": surfaces.lack_of_fit.cell + 1,
    }
    if surfaces.blocks is not None:
        names = texts(surfaces.blocks.names)
        values |= {
            "block_name": names,
            "block_treatment": np.array(surfaces.blocks.treatment),
            "run_block": names[surfaces.blocks.index],
        }
    return values


def _with_shared(
    values: Values, surfaces: ResponseSurfaces, shared: SharedSurfaces, index: int, name: str
) -> Values:
    """Coefficients with what the errors that runs share add to the scatter of the runs."""
    coded = shared.coefficient[:, index]
    slopes = canonical_slopes(
        surfaces.canonical.stationary_point[[index]],
        surfaces.canonical.eigenvalue[[index]],
        surfaces.canonical.eigenvector[[index]],
        surfaces.exponents,
    )
    found: Values = {}
    for what, rows in (
        ("coefficient", coded),
        ("coefficient_engineering", shared.coefficient_engineering[:, index]),
        ("stationary_point", coded @ slopes[0][0].T),
        ("eigenvalue", coded @ slopes[1][0].T),
    ):
        of = f"{name}_{what}"
        found |= both_parts(of, values[f"{of}_standard_uncertainty"], rows)
    return found


def _surface_values(surfaces: ResponseSurfaces, index: int, name: str) -> Values:
    """One surface."""
    anova, lack, canonical = surfaces.anova, surfaces.lack_of_fit, surfaces.canonical
    diagnostics = surfaces.diagnostics
    pattern = surfaces.pattern[index]
    of_response: Values = {
        "coefficient": surfaces.coefficient,
        "coefficient_standard_uncertainty": surfaces.coefficient_standard_uncertainty,
        "coefficient_engineering": surfaces.coefficient_engineering,
        "coefficient_engineering_standard_uncertainty": (
            surfaces.coefficient_engineering_standard_uncertainty
        ),
        "t": surfaces.t,
        "p_value": surfaces.p_value,
        "term_degrees_of_freedom": surfaces.term_degrees_of_freedom,
        "transform": texts(surfaces.transform),
        "transform_exponent": surfaces.transform_exponent,
        "transform_exponent_low": surfaces.transform_exponent_interval[:, 0],
        "transform_exponent_high": surfaces.transform_exponent_interval[:, 1],
        "sigma": surfaces.sigma,
        "degrees_of_freedom": surfaces.degrees_of_freedom,
        "r2": surfaces.r2,
        "adjusted_r2": surfaces.adjusted_r2,
        "predicted_r2": surfaces.predicted_r2,
        "probability_plot_correlation": diagnostics.probability_plot_correlation,
        "overall_f": surfaces.overall_f,
        "overall_p_value": surfaces.overall_p_value,
        "printed_f": surfaces.printed_f,
        "fitted": surfaces.fitted,
        "residual": surfaces.residual,
        "leverage": diagnostics.leverage,
        "cooks_distance": diagnostics.cooks_distance,
        "studentized_residual": diagnostics.studentized_residual,
        "deleted_residual": diagnostics.deleted_residual,
        "lack_of_fit_f": lack.f,
        "lack_of_fit_p_value": lack.p_value,
        "anova_degrees_of_freedom": anova.degrees_of_freedom,
        "anova_sum_of_squares": anova.sum_of_squares,
        "anova_mean_square": anova.mean_square,
        "anova_f": anova.f,
        "anova_p_value": anova.p_value,
        "stationary_point": canonical.stationary_point,
        "stationary_point_standard_uncertainty": canonical.stationary_point_standard_uncertainty,
        "stationary_point_engineering": canonical.stationary_point_engineering,
        "stationary_point_is_inside": canonical.is_inside,
        "stationary_value": canonical.stationary_value,
        "stationary_kind": canonical.kind,
        "eigenvalue": canonical.eigenvalue,
        "eigenvalue_standard_uncertainty": canonical.eigenvalue_standard_uncertainty,
        # the archive has a direction a row
        "eigenvector": canonical.eigenvector.transpose(0, 2, 1),
    }
    if surfaces.blocks is not None:
        of_response |= {
            "block_effect": surfaces.blocks.effect,
            "block_standard_deviation": surfaces.blocks.standard_deviation,
            "block_at_boundary": surfaces.blocks.at_boundary,
        }
    values = {f"{name}_{what}": array[index] for what, array in of_response.items()}
    return values | {
        f"{name}_covariance_factor": surfaces.covariance_factor[pattern],
        f"{name}_n_runs": np.array(surfaces.is_used[pattern].sum()),
        f"{name}_refusal": np.array(FIT_REASONS[int(surfaces.reason[index])]),
        f"{name}_lack_of_fit_refusal": np.array(LACK_OF_FIT_REASONS[int(lack.reason[index])]),
        f"{name}_stationary_refusal": np.array(STATIONARY_REASONS[int(canonical.reason[index])]),
    }


def _reduced_values(reduced: ReducedSurfaces, index: int, name: str) -> Values:
    """The terms that are kept of one surface."""
    infinite = np.isinf(reduced.full_criterion[index])
    return {
        f"{name}_reduced_coefficient": reduced.coefficient[index],
        f"{name}_reduced_coefficient_standard_uncertainty": (
            reduced.coefficient_standard_uncertainty[index]
        ),
        f"{name}_reduced_coefficient_engineering": reduced.coefficient_engineering[index],
        f"{name}_reduced_is_kept": reduced.is_kept[index],
        f"{name}_reduced_sigma": reduced.sigma[index],
        f"{name}_reduced_aicc": reduced.criterion[index],
        # infinite says that the runs are too few for the correction
        f"{name}_full_aicc": np.array(np.nan if infinite else reduced.full_criterion[index]),
    }


def _single_time_values(check: SingleTimeCheck) -> Values:
    values: Values = {
        f"single_time_{name}": np.array(getattr(check, field))
        for field, name in _SINGLE_TIME.items()
    }
    return values | {"single_time_verdict": np.array(VERDICTS[int(check.verdict)])}
