"""From the runs of an experiment to its surfaces, effects and stiffness forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import FitError
from reduction.experiment import ExperimentResult, RunTable
from reduction.line.single import SingleTimeCheck
from reduction.pipeline.runcheck import (
    cautions_of_runs,
    listed,
    missing_surfaces,
    places_in_order,
    remarks_of_runs,
    require_screening_levels,
    surface_levels_off_plan,
)
from reduction.pipeline.runline import (
    REFUSALS,
    LineOfRuns,
    derived_line,
    single_time_of_runs,
    specimen_blocks,
    stiffness_of_runs,
)
from reduction.record import Floats
from reduction.surface.coding import coded_from_engineering
from reduction.surface.designs import Design
from reduction.surface.doubts import drifting_responses, negative_surfaces
from reduction.surface.drift import drift_over_order
from reduction.surface.levels import FactorLevels
from reduction.surface.product import ResponseSurfaces
from reduction.surface.screening import ScreeningEffects, screening_effects, screening_remarks
from reduction.surface.select import ReducedSurfaces, reduce_terms
from reduction.surface.stiffness_product import FormQuality, StiffnessForm
from reduction.surface.surfaces import fit_surfaces
from reduction.surface.transform import Transform

_PREFIX: dict[str, Transform] = {"log_": "log", "box_cox_": "box-cox"}
_FROM_SLOW_PULL = {"dissipation_spring_constant", "relaxation_time", "dashpot_coefficient"}
_SHARED = (
    "t and p of the surfaces of K_1 and tau are of the scatter of the runs; the error of K_0, "
    "which all runs of one slow pull share, is in the uncertainty of the coefficients alone"
)


def fit_experiment(
    runs: RunTable,
    line: LineOfRuns,
    *,
    name: str,
    kind: Literal["box-behnken", "plackett-burman"],
    factors: tuple[FactorLevels, ...],
    factor_units: tuple[str, ...],
    response_names: tuple[str, ...],
    transform: Mapping[str, str],
    specimens_as: Literal["blocks", "random"],
    term_reduction: Literal["none", "aicc"] = "none",
    run_order: ArrayLike | None = None,
) -> ExperimentResult:
    """Everything that the runs of one experiment say together.

    Parameters
    ----------
    runs : RunTable
        As measured.
    line : LineOfRuns
        Of the same runs.
    name, kind : str
        Of the experiment.
    factors : tuple of FactorLevels
        In the unit of ``runs.level``.
    factor_units : tuple of str
        SI units of the levels.
    response_names : tuple of str
        Of the rows of ``runs.response``.
    transform : mapping of str to str
        ``log`` or ``box-cox`` by response.
    specimens_as : {"blocks", "random"}
        How several specimens enter.
    term_reduction : {"none", "aicc"}
        Whether terms are left out too, beside the full surfaces.
    run_order : array_like, shape (n_runs,), optional
        When each run was done, in any rising numbers; NaN where it is not stated. [1]

    Returns
    -------
    result : ExperimentResult
        A part that the runs do not carry is None, and a note says why.
    """
    low, high = (np.array([getattr(one, end) for one in factors]) for end in ("low", "high"))
    notes = remarks_of_runs(runs)
    coded = coded_from_engineering(runs.level, low=low, high=high)
    surfaces: ResponseSurfaces | None = None
    screening: ScreeningEffects | None = None
    forms: tuple[StiffnessForm, ...] = ()
    quality: FormQuality | None = None
    single: SingleTimeCheck | None = None
    reduced: ReducedSurfaces | None = None
    derived = (np.full(len(runs.run), np.nan),) * 2
    names = tuple(one.name for one in factors)
    refusal_status = 0
    try:
        if kind == "plackett-burman":
            screening, remarks = _screening(runs, coded, names, response_names)
            notes += remarks
            if not np.isfinite(screening.effect).any():
                refusal_status = FitError.exit_status
        else:
            notes += surface_levels_off_plan(runs, coded, names)
            surfaces = _surfaces(runs, names, low, high, response_names, transform, specimens_as)
    except REFUSALS as error:
        what = "effects" if kind == "plackett-burman" else "response surfaces"
        notes.append(f"refused: {what}: {error}")
        refusal_status = error.exit_status
    if surfaces is not None:
        notes += missing_surfaces(runs, surfaces, response_names)
        notes += surfaces.notes
        notes += negative_surfaces(surfaces)
        drift = drift_over_order(surfaces, places_in_order(runs, run_order))
        notes += drifting_responses(surfaces, drift)
        if _FROM_SLOW_PULL & set(response_names):
            notes.append(_SHARED)
        if term_reduction == "aicc":
            reduced, remarks = _reduced(surfaces)
            notes += remarks
        forms, quality, remarks = stiffness_of_runs(runs, surfaces, response_names)
        notes += remarks
        derived, remarks = derived_line(runs, line, names, low, high)
        notes += remarks
    if "frequency" in names and "relaxation_time" in response_names:
        single, remarks = single_time_of_runs(
            runs, coded, names.index("frequency"), response_names, line
        )
        notes += remarks
    return ExperimentResult(
        name=name,
        kind=kind,
        factor_names=names,
        factor_units=factor_units,
        low=low,
        high=high,
        response_names=response_names,
        runs=runs,
        surfaces=surfaces,
        screening=screening,
        stiffness_forms=forms,
        form_quality=quality,
        single_time=single,
        derived_dissipation_spring_constant=derived[0],
        derived_relaxation_time=derived[1],
        reduced=reduced,
        cautions=cautions_of_runs(runs, factors, run_order),
        notes=tuple(dict.fromkeys(notes)),
        refusal_status=refusal_status,
    )


def _screening(
    runs: RunTable, coded: Floats, names: tuple[str, ...], response_names: tuple[str, ...]
) -> tuple[ScreeningEffects, list[str]]:
    """Effects by the plan, where the runs kept to it."""
    notes = require_screening_levels(runs, coded, names)
    n_factors = len(names)
    design = Design(
        "plackett-burman", runs.coded_plan[:, :n_factors], runs.coded_plan[:, n_factors:]
    )
    effects = screening_effects(design, runs.response, names=names)
    for reason in dict.fromkeys(effects.reason.tolist()):
        if reason:
            of = effects.reason == reason
            missing = np.isnan(runs.response[of]).any(axis=0)
            without = [run for run, gone in zip(runs.names, missing, strict=True) if gone]
            responses = [one for one, taken in zip(response_names, of, strict=True) if taken]
            notes.append(
                f"refused: effects on {listed(responses)}: {reason}"
                + (f"; no value of {listed(without)}" if without else "")
            )
    return effects, notes + screening_remarks(
        design.dummy.shape[1], specimen_blocks(runs) is not None
    )


def _surfaces(
    runs: RunTable,
    names: tuple[str, ...],
    low: Floats,
    high: Floats,
    response_names: tuple[str, ...],
    transform: Mapping[str, str],
    specimens_as: Literal["blocks", "random"],
) -> ResponseSurfaces:
    """Surfaces of every response, and after them of each that is asked for on another scale."""
    bent = [
        (f"{prefix}{one}", scale, index)
        for index, one in enumerate(response_names)
        for prefix, scale in _PREFIX.items()
        if transform.get(one) == scale
    ]
    as_measured: Transform = "none"
    scales = [*(as_measured for _ in response_names), *(scale for _, scale, _ in bent)]
    rows = [*range(len(response_names)), *(index for _, _, index in bent)]
    return fit_surfaces(
        runs.level,
        runs.response[rows],
        factor_names=names,
        response_names=(*response_names, *(one for one, _, _ in bent)),
        low=low,
        high=high,
        run_names=runs.names,
        blocks=specimen_blocks(runs),
        block_treatment="fixed" if specimens_as == "blocks" else "random",
        transforms=scales,
    )


def _reduced(surfaces: ResponseSurfaces) -> tuple[ReducedSurfaces | None, list[str]]:
    try:
        reduced = reduce_terms(surfaces)
    except REFUSALS as error:
        return None, [f"refused: reduction of terms: {error}"]
    return reduced, list(reduced.notes)
