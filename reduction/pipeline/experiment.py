"""From the runs of an experiment to its surfaces, effects and stiffness forms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from reduction.errors import DataError, FitError, SettingsError
from reduction.experiment import ExperimentResult, RunTable
from reduction.line.identify import identify_by_fundamental
from reduction.line.single import VERDICTS, SingleTimeCheck, check_single_time
from reduction.record import Floats, Integers
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.cautions import Caution, find_cautions
from reduction.surface.designs import Design
from reduction.surface.levels import FactorLevels
from reduction.surface.product import ResponseSurfaces
from reduction.surface.runsheet import RunSheet
from reduction.surface.screening import ScreeningEffects, screening_effects
from reduction.surface.select import ReducedSurfaces, reduce_terms
from reduction.surface.stiffness import (
    compare_stiffness_forms,
    fit_del_vecchio_stiffness,
    fit_mean_load_stiffness,
)
from reduction.surface.stiffness_product import FormQuality, StiffnessForm
from reduction.surface.surfaces import fit_surfaces
from reduction.surface.transform import Transform

__all__ = ["LineOfRuns", "fit_experiment"]

_REFUSALS = (DataError, FitError, SettingsError)
_PREFIX: dict[str, Transform] = {"log_": "log", "box_cox_": "box-cox"}


@dataclass(frozen=True)
class LineOfRuns:
    """What derives K_1 and tau from surfaces of E' and E'', one entry a run. [N]."""

    storage_spring_constant: Floats
    loss_spring_constant: Floats
    quasi_static_spring_constant: Floats


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

    Returns
    -------
    result : ExperimentResult
        A part that the runs do not carry is None, and a note says why.
    """
    low, high = (np.array([getattr(one, end) for one in factors]) for end in ("low", "high"))
    notes = [
        f"{run}: {remark}" for run, remark in zip(runs.names, runs.remark, strict=True) if remark
    ]
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
            design = Design(
                kind, runs.coded_plan[:, : len(factors)], runs.coded_plan[:, len(factors) :]
            )
            screening = screening_effects(design, runs.response, names=names)
        else:
            surfaces = _surfaces(runs, names, low, high, response_names, transform, specimens_as)
    except _REFUSALS as error:
        what = "effects" if kind == "plackett-burman" else "response surfaces"
        notes.append(f"refused: {what}: {error}")
        refusal_status = error.exit_status
    if surfaces is not None:
        notes += surfaces.notes
        if term_reduction == "aicc":
            reduced, remarks = _reduced(surfaces)
            notes += remarks
        forms, quality, remarks = _stiffness(runs, surfaces, response_names)
        notes += remarks
        derived, remarks = _derived(runs, line, names, low, high)
        notes += remarks
    if "frequency" in names and "relaxation_time" in response_names:
        single, remarks = _single_time(runs, names.index("frequency"), response_names, line)
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
        cautions=_cautions(runs, factors),
        notes=tuple(dict.fromkeys(notes)),
        refusal_status=refusal_status,
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
        blocks=runs.specimen if len(set(runs.specimen)) > 1 else None,
        block_treatment="fixed" if specimens_as == "blocks" else "random",
        transforms=scales,
    )


def _reduced(surfaces: ResponseSurfaces) -> tuple[ReducedSurfaces | None, list[str]]:
    try:
        reduced = reduce_terms(surfaces)
    except _REFUSALS as error:
        return None, [f"refused: reduction of terms: {error}"]
    return reduced, list(reduced.notes)


def _stiffness(
    runs: RunTable, surfaces: ResponseSurfaces, response_names: Sequence[str]
) -> tuple[tuple[StiffnessForm, ...], FormQuality | None, list[str]]:
    """Forms that mooring codes ask for, fitted to the apparent spring constant."""
    if "apparent_spring_constant" not in response_names:
        return (), None, []
    spring = runs.response[response_names.index("apparent_spring_constant")]
    strengths = np.unique(runs.rated_break_strength)
    strength = float(strengths[0]) if strengths.size == 1 and strengths[0] > 0 else None
    loads: dict[str, Any] = {
        "mean_tension": runs.mean_tension, "rated_break_strength": strength
    }  # fmt: skip
    try:
        forms = (
            fit_del_vecchio_stiffness(
                spring, tension_amplitude=runs.tension_amplitude, frequency=runs.frequency,
                load_amplitude="half-range", **loads,
            ),
            fit_mean_load_stiffness(spring, **loads),
        )  # fmt: skip
        quality = compare_stiffness_forms(
            spring, tension_amplitude=runs.tension_amplitude, frequency=runs.frequency,
            coded=surfaces.coded, **loads,
        )  # fmt: skip
    except _REFUSALS as error:
        return (), None, [f"refused: stiffness forms of mooring codes: {error}"]
    return forms, quality, []


def _derived(
    runs: RunTable, line: LineOfRuns, names: tuple[str, ...], low: Floats, high: Floats
) -> tuple[tuple[Floats, Floats], list[str]]:
    """K_1 and tau at the levels of each run from surfaces of E' and of the logarithm of E''."""
    missing = np.full(len(runs.run), np.nan)
    parts = np.array([line.storage_spring_constant, line.loss_spring_constant])
    try:
        smooth = fit_surfaces(
            runs.level, parts, factor_names=names, low=low, high=high, run_names=runs.names,
            response_names=("storage_spring_constant", "loss_spring_constant"),
            transforms=("none", "log"),
        )  # fmt: skip
    except _REFUSALS as error:
        return (missing, missing), [f"refused: K_1 and tau from surfaces of E' and E'': {error}"]
    known = np.isfinite(runs.level).all(axis=1)
    at_runs = evaluate_surfaces(smooth, smooth.coded[known], units="coded", outside="flag")
    found = identify_by_fundamental(
        storage_spring_constant=at_runs.value[0],
        loss_spring_constant=at_runs.value[1],
        frequency=runs.frequency[known],
        quasi_static_spring_constant=line.quasi_static_spring_constant[known],
    )
    constant, time = missing.copy(), missing.copy()
    constant[known], time[known] = found.dissipation_spring_constant, found.relaxation_time
    return (constant, time), []


def _single_time(
    runs: RunTable, frequency: int, response_names: Sequence[str], line: LineOfRuns
) -> tuple[SingleTimeCheck | None, list[str]]:
    """Whether one relaxation time holds: runs at equal loads, as planned, are compared."""
    place = response_names.index("relaxation_time")
    time = runs.response[place]
    others = np.delete(runs.coded_plan, frequency, axis=1)
    group = [f"{one} {loads}" for one, loads in zip(runs.specimen, others.tolist(), strict=True)]
    try:
        check = check_single_time(
            runs.frequency, time, line.loss_spring_constant / line.storage_spring_constant,
            group=group,
            relative_standard_uncertainty=runs.response_standard_uncertainty[place] / time,
        )  # fmt: skip
    except _REFUSALS as error:
        return None, [f"refused: check of a single relaxation time: {error}"]
    return check, [VERDICTS[int(check.verdict)]]


def _cautions(runs: RunTable, factors: tuple[FactorLevels, ...]) -> tuple[Caution, ...]:
    """What a run sheet of the runs as they were reached would warn of."""
    order: Integers = np.arange(1, len(runs.run) + 1)
    known = np.isfinite(runs.level).all(axis=1) & np.isfinite(runs.peak_tension)
    sheet = RunSheet(
        factors=factors,
        run=order[known],
        coded=runs.coded_plan[known, : len(factors)],
        engineering=runs.level[known],
        load_block=np.zeros(int(known.sum()), dtype=np.intp),
        mean_tension=runs.mean_tension[known],
        tension_amplitude=runs.tension_amplitude[known],
        peak_tension=runs.peak_tension[known],
        minimum_tension=runs.minimum_tension[known],
        peak_share=(runs.peak_tension / runs.rated_break_strength)[known],
        minimum_share=(runs.minimum_tension / runs.rated_break_strength)[known],
    )
    return find_cautions(sheet) if known.any() else ()
