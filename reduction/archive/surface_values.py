"""What one experiment gives to its archive, by name, without the dimension ``experiment``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.values import Values, texts
from reduction.errors import ArchiveError
from reduction.experiment import ExperimentResult, RunTable
from reduction.line.single import VERDICTS, SingleTimeCheck
from reduction.record import Integers
from reduction.surface.product import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.surface.screening import ScreeningEffects
from reduction.vocabulary import SURFACE_NAMES

__all__ = ["experiment_values"]

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
        If a response has no name, or a run of the surfaces is not a run of the experiment.
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
        place = _places(result.runs, result.surfaces)
        values |= _shared_values(result, result.surfaces, place)
        for index, name in enumerate(result.surfaces.response_names):
            values |= _surface_values(result.surfaces, index, name, place, len(result.runs.run))
    if result.screening is not None:
        values |= _effect_values(result.screening, result.response_names)
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
        values[f"{name}_measured_standard_uncertainty"] = runs.response_standard_uncertainty[index]
    return values


def _places(runs: RunTable, surfaces: ResponseSurfaces) -> Integers:
    """Row of the run table that each run of the surfaces is."""
    rows = {name: row for row, name in enumerate(runs.names)}
    strange = [name for name in surfaces.run_names if name not in rows]
    if strange:
        raise ArchiveError("a surface has runs that its experiment lacks", found=", ".join(strange))
    return np.array([rows[name] for name in surfaces.run_names], dtype=np.int64)


def _at_runs(array: NDArray[Any], place: Integers, n_runs: int) -> NDArray[Any]:
    """Put an entry a run of the surfaces at its run of the experiment; NaN elsewhere."""
    placed = np.full((n_runs, *array.shape[1:]), np.nan)
    placed[place] = array
    return placed


def _shared_values(result: ExperimentResult, surfaces: ResponseSurfaces, place: Integers) -> Values:
    """What all surfaces of an experiment have in common."""
    n_runs = len(result.runs.run)
    cell = np.zeros(n_runs, dtype=np.int32)
    cell[place] = surfaces.lack_of_fit.cell + 1
    values: Values = {
        "term": texts(surfaces.labels),
        "term_other": texts(surfaces.labels),
        "term_name": texts(surfaces.term_names),
        "term_unit_engineering": texts(_term_units(surfaces.exponents, result.factor_units)),
        "term_error": texts(surfaces.error_term),
        "term_exponent": surfaces.exponents,
        "direction": np.arange(1, len(surfaces.factor_names) + 1),
        "anova_source": texts(surfaces.anova.source),
        "anova_error_term": texts(surfaces.anova.error_term),
        "replicate_tolerance": np.array(surfaces.lack_of_fit.tolerance),
        "condition_number": np.array(surfaces.condition_number),
        "run_coded_level": _at_runs(surfaces.coded, place, n_runs),
        "run_cell": cell,
    }
    if surfaces.blocks is not None:
        block = np.full(n_runs, "", dtype=texts(surfaces.blocks.names).dtype)
        block[place] = texts(surfaces.blocks.names)[surfaces.blocks.index]
        values |= {
            "block_name": texts(surfaces.blocks.names),
            "block_treatment": np.array(surfaces.blocks.treatment),
            "run_block": block,
        }
    return values


def _term_units(exponents: Integers, factor_units: Sequence[str]) -> list[str]:
    """Unit by which that of a response is multiplied: ``Hz-1 N-1``; 1 for the mean."""
    return [
        " ".join(
            _power(part, -int(power))
            for unit, power in zip(factor_units, row, strict=True)
            for part in unit.split()
            if power and part != "1"
        )
        or "1"
        for row in exponents
    ]


def _power(part: str, power: int) -> str:
    """One factor of a unit raised to a power: ``m-1`` by -2 is ``m2``."""
    letters = part.rstrip("-0123456789")
    raised = int(part.removeprefix(letters) or 1) * power
    return letters if raised == 1 else f"{letters}{raised}"


def _surface_values(
    surfaces: ResponseSurfaces, index: int, name: str, place: Integers, n_runs: int
) -> Values:
    """One surface."""
    anova, lack, canonical = surfaces.anova, surfaces.lack_of_fit, surfaces.canonical
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
        "probability_plot_correlation": surfaces.diagnostics.probability_plot_correlation,
        "overall_f": surfaces.overall_f,
        "overall_p_value": surfaces.overall_p_value,
        "printed_f": surfaces.printed_f,
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
    of_run: Values = {
        "fitted": surfaces.fitted,
        "residual": surfaces.residual,
        "leverage": surfaces.diagnostics.leverage,
        "cooks_distance": surfaces.diagnostics.cooks_distance,
        "studentized_residual": surfaces.diagnostics.studentized_residual,
        "deleted_residual": surfaces.diagnostics.deleted_residual,
    }
    values |= {
        f"{name}_{what}": _at_runs(array[index], place, n_runs) for what, array in of_run.items()
    }
    return values | {
        f"{name}_covariance_factor": surfaces.covariance_factor[pattern],
        f"{name}_n_runs": np.array(surfaces.is_used[pattern].sum()),
        f"{name}_refusal": np.array(FIT_REASONS[int(surfaces.reason[index])]),
        f"{name}_lack_of_fit_refusal": np.array(LACK_OF_FIT_REASONS[int(lack.reason[index])]),
        f"{name}_stationary_refusal": np.array(STATIONARY_REASONS[int(canonical.reason[index])]),
    }


def _effect_values(effects: ScreeningEffects, response_names: Sequence[str]) -> Values:
    """Effects of the factors and then of the dummies, which are not tested."""
    values: Values = {
        "effect_error_from": np.array(effects.error_from),
        "effect_degrees_of_freedom": np.array(effects.degrees_of_freedom),
        "effect_significance": np.array(effects.significance),
    }
    untested = np.full(effects.dummy_effect.shape[-1], np.nan)
    for index, name in enumerate(response_names):
        values |= {
            f"{name}_effect": np.append(effects.effect[index], effects.dummy_effect[index]),
            f"{name}_effect_standard_uncertainty": effects.effect_standard_error[index],
            f"{name}_effect_t": np.append(effects.t_value[index], untested),
            f"{name}_effect_p_value": np.append(effects.p_value[index], untested),
            f"{name}_effect_is_significant": np.append(
                effects.is_significant[index], np.zeros(untested.size, dtype=bool)
            ),
            f"{name}_effect_refusal": np.array(str(effects.reason[index])),
            f"{name}_mean": effects.mean[index],
            f"{name}_minimum_significant_effect": effects.minimum_significant_effect[index],
            f"{name}_simultaneous_minimum_effect": effects.simultaneous_minimum_effect[index],
        }
    return values


def _single_time_values(check: SingleTimeCheck) -> Values:
    values: Values = {
        f"single_time_{name}": np.array(getattr(check, field))
        for field, name in _SINGLE_TIME.items()
    }
    return values | {"single_time_verdict": np.array(VERDICTS[int(check.verdict)])}
