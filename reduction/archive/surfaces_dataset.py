"""Writes and reads the archive of response surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.dataset_builder import build_dataset, part_attributes
from reduction.archive.shared_errors import component_values
from reduction.archive.variables import Values, note_values, pad, read_notes, stored, texts
from reduction.experiments.block_effects import block_columns
from reduction.experiments.designs import engineering_matrix
from reduction.experiments.experiment import ExperimentResult, RunTable, SharedSurfaces
from reduction.experiments.fit_results import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_REASONS,
    Anova,
    BlockEffects,
    Canonical,
    Diagnostics,
    LackOfFit,
    ResponseSurfaces,
)
from reduction.experiments.run_sheet import SIGNIFICANCE
from reduction.experiments.screening import ScreeningEffects, alias_matrix
from reduction.experiments.stationary_point import canonical_slopes
from reduction.experiments.stiffness_forms import FormQuality, StiffnessForm
from reduction.experiments.surface_points import evaluate_surfaces, plan_points
from reduction.quantities.names import RESPONSES, SURFACE_NAMES, SURFACE_SCHEMA
from reduction.quantities.units import combined_unit
from reduction.record.contributions import CONFIDENCE, combined_standard_uncertainty
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Floats, Integers, Origin
from reduction.record.notes import Note
from reduction.stages.three_parameter_line.line_model import VERDICTS, SingleTimeCheck
from reduction.uncertainty.surface_errors import with_shared_at_points


def effect_values(effects: ScreeningEffects, response_names: Sequence[str]) -> Values:
    """Return the effects of the factors, followed by those of the dummies without a test."""
    values: Values = {
        "effect_error_from": np.array(effects.error_from),
        "effect_degrees_of_freedom": np.array(effects.degrees_of_freedom),
        "effect_significance": np.array(SIGNIFICANCE),
    }
    untested = np.full(effects.dummy_effect.shape[-1], np.nan)
    every = np.concatenate([effects.effect, effects.dummy_effect], axis=-1)
    for index, name in enumerate(response_names):
        values |= {
            f"{name}_effect": every[index],
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


def alias_values(plan: Floats, factor_names: Sequence[str]) -> Values:
    """Return the share of each two-factor interaction in the effect of each column.

    Values by names of `reduction.quantities.names`; empty for a single factor.

    Notes
    -----
    The dummies are columns like the factors: interactions aliased with them contribute to the error
    by which the effects are judged.  No interaction is aliased with the mean of an orthogonal plan.
    """
    n_factors = len(factor_names)
    pairs, alias = alias_matrix(plan)
    of_factors = [place for place, pair in enumerate(pairs) if max(pair) < n_factors]
    if not of_factors:
        return {}
    named = list(combinations(factor_names, 2))
    # the number of runs in which an interaction follows a column is an integer: removes rounding
    n_runs = plan.shape[0]
    share = np.rint(alias[1:, of_factors].T * n_runs) / n_runs + 0.0
    return {
        "interaction": np.arange(1, len(named) + 1),
        "interaction_factor": texts([one for one, _ in named]),
        "interaction_other_factor": texts([other for _, other in named]),
        "effect_alias": share,
    }


_QUALITY = (
    "n_coefficients",
    "sigma",
    "degrees_of_freedom",
    "r2",
    "adjusted_r2",
    "predicted_r2",
    "prediction_sum_of_squares",
    "aicc",
)

_COLUMNS = {
    "stiffness_coefficient": "coefficient",
    "stiffness_coefficient_standard_uncertainty": "coefficient_standard_uncertainty",
    "stiffness_coefficient_low": "coefficient_low",
    "stiffness_coefficient_high": "coefficient_high",
    "stiffness_p_value": "p_value",
    "stiffness_fitted": "stiffness_fitted",
    "stiffness_residual": "stiffness_residual",
    "stiffness_confidence": "confidence",
    "stiffness_mean_load_range": "mean_load_range",
}

_LABELS = {
    "stiffness_coefficient_name": "coefficient_names",
    "stiffness_coefficient_unit": "coefficient_units",
}


def _stiffness_values(forms: Sequence[StiffnessForm], quality: FormQuality) -> Values:
    """Return the forms of one response, compared with the quadratic surface of the same runs.

    Values by names of `reduction.quantities.names`, without the dimension ``experiment``; a form
    without coefficients of its own has only its quality.
    """
    n_forms = len(quality.forms)
    size = max(len(form.coefficient_names) for form in forms)
    missing = [[np.nan]] * (n_forms - len(forms))
    values: Values = {
        "stiffness_form": texts(quality.forms),
        "stiffness_term": np.arange(1, size + 1),
        "stiffness_term_other": np.arange(1, size + 1),
        "stiffness_refusal": quality.reason,
    }
    values |= {f"stiffness_{name}": np.array(getattr(quality, name)) for name in _QUALITY}
    for name, field in _COLUMNS.items():
        values[name] = pad([*(np.ravel(getattr(form, field)) for form in forms), *missing])
    covariance = np.full((n_forms, size, size), np.nan)
    for table, form in zip(covariance, forms, strict=False):
        n = len(form.coefficient_names)
        table[:n, :n] = form.covariance
    values["stiffness_covariance"] = covariance
    for name, field in _LABELS.items():
        table = np.full((n_forms, size), "", dtype=object)
        for row, form in enumerate(forms):
            labels = getattr(form, field)
            table[row, : len(labels)] = labels
        values[name] = table.astype(np.str_)
    ends = values.pop("stiffness_mean_load_range")
    values |= {
        "stiffness_mean_load_low": ends[:, 0],
        "stiffness_mean_load_high": ends[:, 1],
        "stiffness_confidence": values["stiffness_confidence"][:, 0],
    }
    nothing = [""] * len(missing)
    return values | {"stiffness_equation": texts([*(form.equation for form in forms), *nothing])}


def point_values(
    surfaces: ResponseSurfaces, plan: Floats, shared: SharedSurfaces | None = None
) -> Values:
    """Return every surface at the centre, the plan points and the corners."""
    points = plan_points(plan)
    found = evaluate_surfaces(surfaces, points.coded, units="coded", outside="flag", plan=plan)
    both = with_shared_at_points(surfaces, found, *_rows(surfaces, shared))
    values: Values = {
        "interval_confidence": np.array(CONFIDENCE),
        "point": np.arange(1, len(points.name) + 1),
        "point_name": texts(points.name),
        "point_kind": texts(points.kind),
        "point_coded_level": found.coded,
        "point_level": found.engineering,
    }
    for index, name in enumerate(surfaces.response_names):
        values |= {
            f"{name}_point_value": found.value[index],
            f"{name}_point_mean_value": found.mean_value[index],
            f"{name}_point_variance_factor": found.variance_factor[index],
            f"{name}_point_is_above_leverage": found.above_leverage[index],
            f"{name}_point_discrepancy": both.discrepancy[index],
            f"{name}_point_value_degrees_of_freedom": both.degrees_of_freedom[index],
        }
        values |= _both_parts(
            f"{name}_point_value",
            both.random_standard_uncertainty[index],
            None if shared is None else both.contribution[:, index],
        )
        for kind in ("confidence", "prediction", "simultaneous"):
            ends = getattr(both, f"{kind}_interval")[index]
            values[f"{name}_point_{kind}_low"] = ends[:, 0]
            values[f"{name}_point_{kind}_high"] = ends[:, 1]
    return values


def _both_parts(name: str, random: Floats, rows: Floats | None) -> Values:
    """Return the uncertainty of a quantity with its parts; a single part is not repeated."""
    if rows is None:
        return {f"{name}_standard_uncertainty": random}
    return {
        f"{name}_standard_uncertainty": combined_standard_uncertainty(rows, random),
        f"{name}_random_standard_uncertainty": random,
        f"{name}_uncertainty_contribution": rows,
    }


def _rows(surfaces: ResponseSurfaces, shared: SharedSurfaces | None) -> tuple[Floats, Floats]:
    """Contributions to the coefficients, and the degrees of freedom of each shared error."""
    if shared is None:
        return np.zeros((0, *surfaces.coefficient.shape)), np.zeros(0)
    return shared.coefficient, np.array([one.degrees_of_freedom for one in shared.component])


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
"""Name after ``single_time_``, by the field of the check."""


def _experiment_values(result: ExperimentResult) -> Values:
    """Return all numbers and texts of an experiment except notes and stiffness forms."""
    fitted = () if result.surfaces is None else result.surfaces.response_names
    strange = sorted({*result.response_names, *fitted} - set(SURFACE_NAMES))
    if strange:
        raise ArchiveError(
            "a response has no name in the archive",
            found=", ".join(strange),
            needed="a response of reduction.quantities.names, or its transform",
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
        values |= _common_values(result.surfaces, result.factor_units)
        if result.shared is not None:
            values |= component_values(result.shared.component)
        for index, name in enumerate(result.surfaces.response_names):
            values |= _surface_values(result.surfaces, index, name)
            if result.shared is not None:
                values |= _with_shared(values, result.surfaces, result.shared, index, name)
        plan = result.runs.coded_plan[:, : len(result.factor_names)]
        values |= point_values(result.surfaces, plan, result.shared)
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
        "run_remark": texts(["; ".join(map(str, one)) for one in runs.remarks]),
        "run_plan": runs.coded_plan,
        "run_level": runs.level,
    }
    values |= {f"run_{name}": getattr(runs, name) for name in _RUN_COLUMNS}
    for index, name in enumerate(response_names):
        values[f"{name}_measured"] = runs.response[index]
        random = runs.response_standard_uncertainty[index]
        whole = random
        if runs.shared is not None:
            whole = combined_standard_uncertainty(runs.shared.values[name], random)
            values[f"{name}_measured_random_standard_uncertainty"] = random
        if runs.response_whole_uncertainty is not None:
            stated = runs.response_whole_uncertainty[index]
            whole = np.where(np.isfinite(stated), stated, whole)
        values[f"{name}_measured_standard_uncertainty"] = whole
    return values


def _common_values(surfaces: ResponseSurfaces, factor_units: Sequence[str]) -> Values:
    """Values common to all surfaces of an experiment."""
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
    """Coefficients with the shared errors of the runs added to their scatter."""
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
        found |= _both_parts(of, values[f"{of}_standard_uncertainty"], rows)
    return found


def _surface_values(surfaces: ResponseSurfaces, index: int, name: str) -> Values:
    """Values of one surface."""
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
        # the archive has one direction per row
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


def _single_time_values(check: SingleTimeCheck) -> Values:
    values: Values = {
        f"single_time_{name}": np.array(getattr(check, field))
        for field, name in _SINGLE_TIME.items()
    }
    return values | {"single_time_verdict": np.array(VERDICTS[int(check.verdict)])}


def surfaces_to_dataset(results: Sequence[ExperimentResult], *, origin: Origin) -> xr.Dataset:
    """Convert experiments to the archive dataset, without writing a file."""
    names = [result.name for result in results]
    values = _stacked([_values_of(result) for result in results])
    values |= {"experiment": texts(names)} | _note_values(results) | _caution_values(results)
    return build_dataset(
        {
            name: array
            for name, array in values.items()
            if array.dtype.kind != "U" or any(array.flat)
        },
        SURFACE_SCHEMA,
        attributes=part_attributes("surfaces", names, origin=origin),
    )


def _values_of(result: ExperimentResult) -> Values:
    values = _experiment_values(result)
    if result.form_quality is not None and result.stiffness_forms:
        values |= _stiffness_values(result.stiffness_forms, result.form_quality)
    return values


def _stacked(parts: Sequence[Values]) -> Values:
    """Stack experiments; each axis of the file is the longest of its kind."""
    sizes: dict[str, int] = {}
    for part in parts:
        for name, array in part.items():
            for dim, length in zip(_own_dims(name), array.shape, strict=True):
                sizes[dim] = max(length, sizes.get(dim, 0))
    values: Values = {}
    for name in dict.fromkeys(name for part in parts for name in part):
        if "experiment" in SURFACE_SCHEMA[name].dims:
            shape = tuple(sizes[dim] for dim in _own_dims(name))
            values[name] = np.stack([_padded(name, part.get(name), shape) for part in parts])
        else:
            values[name] = max((part[name] for part in parts if name in part), key=len)
    return values


def _padded(name: str, array: NDArray[Any] | None, shape: tuple[int, ...]) -> NDArray[Any]:
    """Pad an array to the longest length; create it if absent."""
    row = SURFACE_SCHEMA[name]
    fill = "" if row.is_text else np.nan if row.dtype == "f8" else 0
    if array is None:
        return np.full(shape, fill, dtype=row.dtype)
    padded: NDArray[Any] = np.full(shape, fill, dtype=array.dtype if row.is_text else row.dtype)
    padded[tuple(slice(length) for length in array.shape)] = array
    return padded


def _own_dims(name: str) -> tuple[str, ...]:
    return tuple(dim for dim in SURFACE_SCHEMA[name].dims if dim != "experiment")


def _note_values(results: Sequence[ExperimentResult]) -> Values:
    """Notes of surfaces with their own stage, without repeats."""
    names: list[str] = []
    notes: list[Note] = []
    for result in results:
        of_surfaces = () if result.surfaces is None else result.surfaces.notes
        own = [one for one in result.notes if one not in of_surfaces]
        notes += [replace(one, stage="surfaces") for one in of_surfaces]
        notes += [replace(one, stage="experiment") for one in own]
        names += [result.name] * (len(of_surfaces) + len(own))
    return {"note_experiment": texts(names), **note_values(notes)}


def _caution_values(results: Sequence[ExperimentResult]) -> Values:
    """Cautions, with the names of the runs, which they count from 1."""
    rows = [
        (
            result.name,
            caution.kind,
            caution.message,
            caution.hint,
            ", ".join(result.runs.run[number - 1] for number in caution.runs),
        )
        for result in results
        for caution in result.cautions
    ]
    names = ("caution_experiment", "caution_kind", "caution", "caution_hint", "caution_runs")
    return {name: texts([row[column] for row in rows]) for column, name in enumerate(names)}


_SPREAD = "_standard_uncertainty"

_LABEL_OF_DIM = {
    "factor": "factor_name",
    "term": "term_name",
    "run": "run_name",
    "anova_row": "anova_source",
    "block": "block_name",
}
"""Text variable that shows how much of a dimension an experiment uses."""


def is_share_of_mean(level: Floats, mean: Floats, amplitude: Floats) -> bool:
    """Whether levels of a load amplitude are shares of the mean load, by those of the runs."""
    known = np.isfinite(level) & np.isfinite(mean) & np.isfinite(amplitude)
    return bool(known.any()) and np.allclose(level[known] * mean[known], amplitude[known])


def surface_names(dataset: xr.Dataset, experiment: str) -> tuple[str, ...]:
    """Return the responses of an experiment with a surface, transformed ones last.

    Names from `reduction.quantities.names.SURFACE_NAMES`; empty for a screening.
    """
    row = _row_of(dataset, experiment)
    return tuple(
        name
        for name in SURFACE_NAMES
        if f"{name}_transform" in dataset
        and str(dataset.variables[f"{name}_transform"].values[row])
    )


def surfaces_of(dataset: xr.Dataset, experiment: str) -> ResponseSurfaces:
    """Return the fitted surfaces; `reduction.experiments` accepts them like new ones."""
    names = surface_names(dataset, experiment)
    if not names:
        raise ArchiveError(
            f"experiment '{experiment}' has no surface", needed="an experiment with surfaces"
        )
    return _Reader(dataset, _row_of(dataset, experiment), names).surfaces()


def _row_of(dataset: xr.Dataset, experiment: str) -> int:
    known = (
        []
        if "experiment" not in dataset
        else dataset.variables["experiment"].values.astype(str).tolist()
    )
    if experiment not in known:
        raise ArchiveError(
            "the archive has no such experiment",
            found=experiment,
            needed=", ".join(known) or "an archive of experiments",
        )
    return known.index(experiment)


class _Reader:
    """Reads one experiment of an archive, without padding."""

    def __init__(self, dataset: xr.Dataset, row: int, names: tuple[str, ...]) -> None:
        self.dataset, self.row, self.names = dataset, row, names
        self.sizes: dict[str, int] = {}
        for dim, label in _LABEL_OF_DIM.items():
            if label in dataset:
                self.sizes[dim] = int(np.count_nonzero(dataset[label].values[row].astype(str)))
        self.sizes["term_other"] = self.sizes["term"]
        self.sizes["direction"] = self.sizes["factor"]

    def own(self, name: str) -> NDArray[Any]:
        """Return a variable of this experiment."""
        variable = self.dataset.variables[name]
        cut = tuple(slice(self.sizes[str(dim)]) for dim in variable.dims[1:])
        values: NDArray[Any] = np.asarray(variable.values[self.row])[cut]
        return values

    def labels(self, name: str) -> tuple[str, ...]:
        """Return a text of this experiment; empty if the file has none."""
        dim = str(SURFACE_SCHEMA[name].dims[1])
        if name not in self.dataset:
            return ("",) * self.sizes[dim]
        return tuple(str(text) for text in self.own(name))

    def stack(self, what: str) -> NDArray[Any]:
        """Return a value for each response, with responses on the first axis."""
        return np.stack([self.own(f"{name}_{what}") for name in self.names])

    def random(self, what: str) -> Floats:
        """Return the uncertainty of each response due to the scatter of its runs only."""
        kind = "_random" if f"{self.names[0]}_{what}_random{_SPREAD}" in self.dataset else ""
        return self.stack(f"{what}{kind}{_SPREAD}")

    def codes(self, what: str, reasons: dict[int, str]) -> NDArray[np.int8]:
        """Return the code of each reason; empty for an archive without the text."""
        code = {text: number for number, text in reasons.items()}
        texts = [stored(self.dataset, f"{name}_{what}") for name in self.names]
        found = [0 if text is None else code[str(text.values[self.row])] for text in texts]
        return np.array(found, dtype=np.int8)

    def surfaces(self) -> ResponseSurfaces:
        """Rebuild the surfaces."""
        exponents = self.own("term_exponent").astype(np.int64)
        low, high = self.own("factor_low"), self.own("factor_high")
        return ResponseSurfaces(
            response_names=self.names,
            factor_names=self.labels("factor_name"),
            run_names=self.run_names(),
            low=low,
            high=high,
            coded=self.own("run_coded_level"),
            exponents=exponents,
            term_names=self.labels("term_name"),
            transform=tuple(str(text) for text in self.stack("transform")),
            transform_exponent=self.stack("transform_exponent"),
            transform_exponent_interval=np.stack(
                [self.stack("transform_exponent_low"), self.stack("transform_exponent_high")],
                axis=-1,
            ),
            coefficient=self.stack("coefficient"),
            coefficient_standard_uncertainty=self.random("coefficient"),
            t=self.stack("t"),
            p_value=self.stack("p_value"),
            term_degrees_of_freedom=self.stack("term_degrees_of_freedom"),
            error_term=self.labels("term_error"),
            coefficient_engineering=self.stack("coefficient_engineering"),
            coefficient_engineering_standard_uncertainty=self.random("coefficient_engineering"),
            covariance_factor=self.stack("covariance_factor"),
            engineering_matrix=engineering_matrix(exponents, low=low, high=high),
            pattern=np.arange(len(self.names)),
            is_used=np.isfinite(self.measured()),
            sigma=self.stack("sigma"),
            degrees_of_freedom=self.counts("degrees_of_freedom"),
            r2=self.stack("r2"),
            adjusted_r2=self.stack("adjusted_r2"),
            predicted_r2=self.stack("predicted_r2"),
            overall_f=self.stack("overall_f"),
            overall_p_value=self.stack("overall_p_value"),
            printed_f=self.stack("printed_f"),
            fitted=self.stack("fitted"),
            residual=self.stack("residual"),
            anova=self.anova(),
            lack_of_fit=self.lack_of_fit(),
            canonical=self.canonical(),
            diagnostics=Diagnostics(
                leverage=self.stack("leverage"),
                cooks_distance=self.stack("cooks_distance"),
                studentized_residual=self.stack("studentized_residual"),
                deleted_residual=self.stack("deleted_residual"),
                probability_plot_correlation=self.stack("probability_plot_correlation"),
            ),
            blocks=self.blocks(),
            condition_number=float(self.own("condition_number")),
            reason=self.codes("refusal", FIT_REASONS),
            notes=self.notes(),
        )

    def run_names(self) -> tuple[str, ...]:
        """Return the run names as in `RunTable.names`, with the specimen if there are several."""
        runs, specimens = self.labels("run_name"), self.labels("run_specimen")
        many = len(set(specimens)) > 1
        pairs = zip(runs, specimens, strict=True)
        return tuple(f"{run} {specimen}" if many else run for run, specimen in pairs)

    def measured(self) -> Floats:
        """Return the untransformed response of each surface."""
        of = [next(base for base in RESPONSES if name.endswith(base)) for name in self.names]
        return np.stack([self.own(f"{base}_measured") for base in of])

    def counts(self, what: str) -> Integers:
        """Return counts, 0 for an absent surface."""
        counted: Integers = np.nan_to_num(self.stack(what)).astype(np.int64)
        return counted

    def anova(self) -> Anova:
        """Return the analysis of variance."""
        return Anova(
            source=self.labels("anova_source"),
            degrees_of_freedom=self.stack("anova_degrees_of_freedom"),
            sum_of_squares=self.stack("anova_sum_of_squares"),
            mean_square=self.stack("anova_mean_square"),
            f=self.stack("anova_f"),
            p_value=self.stack("anova_p_value"),
            error_term=self.labels("anova_error_term"),
        )

    def lack_of_fit(self) -> LackOfFit:
        """Return the lack of fit from the analysis of variance, with the repeats."""
        source = self.labels("anova_source")
        lack, pure = source.index("lack of fit"), source.index("pure error")
        squares = self.stack("anova_sum_of_squares")
        freedom = self.counts("anova_degrees_of_freedom")
        return LackOfFit(
            degrees_of_freedom=freedom[:, lack],
            pure_error_degrees_of_freedom=freedom[:, pure],
            sum_of_squares=squares[:, lack],
            pure_error_sum_of_squares=squares[:, pure],
            f=self.stack("lack_of_fit_f"),
            p_value=self.stack("lack_of_fit_p_value"),
            reason=self.codes("lack_of_fit_refusal", LACK_OF_FIT_REASONS),
            cell=self.own("run_cell").astype(np.int64) - 1,
            tolerance=float(self.own("replicate_tolerance")),
        )

    def canonical(self) -> Canonical:
        """Return stationary points and principal directions."""
        return Canonical(
            stationary_point=self.stack("stationary_point"),
            stationary_point_engineering=self.stack("stationary_point_engineering"),
            stationary_point_standard_uncertainty=self.random("stationary_point"),
            stationary_value=self.stack("stationary_value"),
            eigenvalue=self.stack("eigenvalue"),
            eigenvalue_standard_uncertainty=self.random("eigenvalue"),
            eigenvector=self.stack("eigenvector").transpose(0, 2, 1),
            kind=self.stack("stationary_kind").astype(np.int8),
            is_inside=self.stack("stationary_point_is_inside").astype(bool),
            reason=self.codes("stationary_refusal", STATIONARY_REASONS),
        )

    def blocks(self) -> BlockEffects | None:
        """Return the block effects; None for a single block."""
        treatment = str(self.own("block_treatment")) if "block_treatment" in self.dataset else ""
        if not treatment:
            return None
        names, index, _ = block_columns(self.labels("run_block"))
        return BlockEffects(
            names=names,
            index=index,
            treatment=treatment,
            effect=self.stack("block_effect"),
            standard_deviation=self.stack("block_standard_deviation"),
            at_boundary=self.stack("block_at_boundary").astype(bool),
        )

    def notes(self) -> tuple[Note, ...]:
        """Return the notes on the surfaces."""
        name = str(self.dataset.variables["experiment"].values[self.row])
        own = read_notes(self.dataset, of=("note_experiment", name))
        return tuple(one for one in own if one.stage == "surfaces")
