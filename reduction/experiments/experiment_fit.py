"""Checks of the runs of an experiment, and fits of its response surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import Design, FactorLevels, coded_from_engineering
from reduction.experiments.experiment import ExperimentResult, RunTable
from reduction.experiments.fit_results import FIT_REASONS, NO_SURFACE, ResponseSurfaces
from reduction.experiments.least_squares_fit import replicate_cells
from reduction.experiments.response_surfaces import OBJECTS, fit_surfaces, scatter_by_scale
from reduction.experiments.response_transform import Transform
from reduction.experiments.run_sheet import (
    NOT_OF_PLAN,
    ON_PLAN,
    Caution,
    RunSheet,
    find_cautions,
    levels_off_plan,
)
from reduction.experiments.screening import ScreeningEffects, screening_effects, screening_remarks
from reduction.experiments.stiffness_forms import (
    FormQuality,
    StiffnessForm,
    compare_stiffness_forms,
    fit_del_vecchio_stiffness,
    fit_mean_load_stiffness,
)
from reduction.experiments.surface_discrepancy import discrepancy_of
from reduction.experiments.surface_warnings import (
    drift_over_order,
    drifting_responses,
    negative_surfaces,
    outlying_runs,
)
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.stages.three_parameter_line.line_model import (
    VERDICTS,
    SingleTimeCheck,
    check_single_time,
    identify_by_fundamental,
)
from reduction.stages.three_parameter_line.line_product import LINE_PARAMETERS

_OFF_SCREENING = 0.1

_OF_ORDER = ("pure-error-excludes-drift", "order-confounded")


def _listed(words: Sequence[str], *, between: str = ", ") -> str:
    """The first few of several words, and the number of the others."""
    more = f" and {len(words) - 5} more" if len(words) > 5 else ""
    return between.join(words[:5]) + more


def _remarks_of_runs(runs: RunTable) -> list[Note]:
    """One note for each remark, with the runs that have it."""
    of_remark: dict[Note, list[str]] = {}
    for run, remarks in zip(runs.names, runs.remarks, strict=True):
        for remark in remarks:
            of_remark.setdefault(remark, []).append(run)
    return [replace(remark, subject=_listed(names)) for remark, names in of_remark.items()]


def _levels_off_plan(
    runs: RunTable, coded: Floats, names: Sequence[str], *, code: str, noted: float
) -> list[Note]:
    """A note where runs strayed from the plan; `DataError` where they belong to another plan."""
    given = {"run_names": runs.names, "factor_names": names}
    plan = runs.coded_plan[:, : len(names)]
    wrong = levels_off_plan(coded, plan, beyond=NOT_OF_PLAN, **given)
    if wrong:
        raise DataError(
            "levels reached are not those of the plan",
            found=_listed(wrong, between="; "),
            needed=f"levels within {NOT_OF_PLAN:g} coded of the plan",
            hint="Look whether runs or logs are swapped, and at the units of levels and loads; "
            "correct runs or factors of the experiment.",
        )
    words = levels_off_plan(coded, plan, beyond=noted, **given)
    return [note(code, limit=noted, where=_listed(words, between="; "))] if words else []


def _missing_surfaces(
    runs: RunTable, surfaces: ResponseSurfaces, response_names: Sequence[str]
) -> list[Note]:
    """Responses without a surface, with the remarks of the runs; one note for equal causes."""
    alike: dict[tuple[int, bytes], list[int]] = {}
    for row in range(len(response_names)):
        reason = int(surfaces.reason[row])
        if reason in NO_SURFACE:
            key = (reason, np.isfinite(runs.response[row]).tobytes())
            alike.setdefault(key, []).append(row)
    notes = []
    for (reason, _), rows in alike.items():
        has = np.isfinite(runs.response[rows[0]])
        notes.append(
            note(
                "no-surface",
                responses=", ".join(response_names[row] for row in rows),
                reason=FIT_REASONS[reason],
                n_runs=int(has.sum()),
                n_all=has.size,
                n_terms=len(surfaces.term_names),
                causes=_causes(runs, ~has),
            )
        )
    return notes


def _causes(runs: RunTable, chosen: Bools) -> str:
    """Main reasons of the chosen runs, which are first in their remarks, by frequency."""
    reasons = [str(one) for row in np.flatnonzero(chosen) for one in runs.remarks[row][:1]]
    often = sorted(set(reasons), key=lambda text: (-reasons.count(text), text))
    said = [f"{text} ({reasons.count(text)} of them)" for text in often[:2]]
    return f": {'; '.join(said)}" if said else ""


def _places_in_order(runs: RunTable, run_order: ArrayLike | None) -> Floats:
    """Place of each run among those of its specimen, from 1; NaN where no order is stated."""
    order = np.full(len(runs.run), np.nan)
    stated = order if run_order is None else np.asarray(run_order, dtype=np.float64)
    for specimen in set(runs.specimen):
        rows = np.flatnonzero([one == specimen for one in runs.specimen])
        rows = rows[np.isfinite(stated[rows])]
        order[rows] = np.unique(stated[rows], return_inverse=True)[1].ravel() + 1
    return order


def _cautions_of_runs(
    runs: RunTable, factors: tuple[FactorLevels, ...], run_order: ArrayLike | None
) -> tuple[Caution, ...]:
    """Warnings of a run sheet made from the runs as they were reached, specimen by specimen.

    Specimens that are pulled in one run are one line of the sheet, with the worst of them.
    """
    known = np.isfinite(runs.level).all(axis=1) & np.isfinite(runs.peak_tension)
    rows_of: dict[str, list[int]] = {}
    for row in np.flatnonzero(known).tolist():
        rows_of.setdefault(runs.run[row], []).append(row)
    sheets: dict[tuple[str, ...], list[str]] = {}
    for run, rows in rows_of.items():
        sheets.setdefault(tuple(runs.specimen[row] for row in rows), []).append(run)
    stated = np.full(len(runs.run), np.nan) if run_order is None else np.asarray(run_order)
    found: list[Caution] = []
    for specimens, names in sheets.items():
        order = stated[[rows_of[run][0] for run in names]]
        is_ordered = bool(np.isfinite(order).all())
        if is_ordered:
            names = [names[place] for place in np.argsort(order, kind="stable")]
        sheet = _sheet(runs, factors, [rows_of[run] for run in names])
        for caution in find_cautions(sheet, run_names=names, is_measured=True):
            message = caution.message
            if len(sheets) > 1 and caution.kind == "no-repeats":
                continue  # another specimen may hold the repeats
            if len(sheets) > 1 and not caution.runs:
                message = f"{', '.join(specimens)}: {message}"
            if caution.kind in _OF_ORDER and not is_ordered:
                message += " (runs as the campaign lists them: it states no order)"
            found.append(replace(caution, message=message))
    return tuple(found)


def _sheet(
    runs: RunTable, factors: tuple[FactorLevels, ...], rows: Sequence[list[int]]
) -> RunSheet:
    """One line for each run, numbered by its first row from 1."""
    first: Integers = np.array([group[0] for group in rows])

    def each(values: Floats, how: np.ufunc | None = None) -> Floats:
        parts = [values[group] for group in rows]
        return np.array([part.mean(axis=0) if how is None else how.reduce(part) for part in parts])

    return RunSheet(
        factors=factors,
        run=first + 1,
        coded=runs.coded_plan[first, : len(factors)],
        engineering=each(runs.level),
        load_block=np.zeros(first.size, dtype=np.intp),
        mean_tension=each(runs.mean_tension),
        tension_amplitude=each(runs.tension_amplitude),
        peak_tension=each(runs.peak_tension, np.maximum),
        minimum_tension=each(runs.minimum_tension, np.minimum),
        peak_share=each(runs.peak_tension / runs.rated_break_strength, np.maximum),
        minimum_share=each(runs.minimum_tension / runs.rated_break_strength, np.minimum),
    )


REFUSALS = (DataError, FitError, SettingsError)
"""Errors that turn a part of an experiment into a note instead of a result."""


@dataclass(frozen=True)
class LineOfRuns:
    """Inputs for K_1 and tau from surfaces of E' and E'', one entry per run. [N]."""

    storage_spring_constant: Floats
    loss_spring_constant: Floats
    quasi_static_spring_constant: Floats


def _specimen_blocks(runs: RunTable) -> tuple[str, ...] | None:
    """Specimen of each run, if there are several."""
    return runs.specimen if len(set(runs.specimen)) > 1 else None


def _stiffness_of_runs(
    runs: RunTable, surfaces: ResponseSurfaces, response_names: Sequence[str]
) -> tuple[tuple[StiffnessForm, ...], FormQuality | None, list[Note]]:
    """Forms required by mooring codes, fitted to the apparent spring constant."""
    if "apparent_spring_constant" not in response_names:
        return (), None, []
    spring = runs.response[response_names.index("apparent_spring_constant")]
    used = np.isfinite(spring) & np.isfinite(surfaces.coded).all(axis=1)
    strengths = np.unique(runs.rated_break_strength[used])
    if strengths.size > 1:
        several = f"the runs are of lines of {strengths.size} break strengths"
        reason = f"{several}, or not of every line is one stated"
        return (), None, [note("no-stiffness-forms", reason=reason)]
    strength = float(strengths[0]) if strengths.size and strengths[0] > 0 else None
    spring, frequency = spring[used], runs.frequency[used]
    loads: dict[str, Any] = {
        "mean_tension": runs.mean_tension[used], "rated_break_strength": strength
    }  # fmt: skip
    amplitude = runs.tension_amplitude[used]
    try:
        forms = (
            fit_del_vecchio_stiffness(
                spring, tension_amplitude=amplitude, frequency=frequency,
                load_amplitude="half-range", **loads,
            ),
            fit_mean_load_stiffness(spring, **loads),
        )  # fmt: skip
        quality = compare_stiffness_forms(
            spring, tension_amplitude=amplitude, frequency=frequency,
            coded=surfaces.coded[used], **loads,
        )  # fmt: skip
    except REFUSALS as error:
        return (), None, [note("no-stiffness-forms", reason=str(error))]
    if _specimen_blocks(runs) is None:
        return forms, quality, []
    return forms, quality, [note("stiffness-forms-pooled")]


def _derived_line(
    runs: RunTable, line: LineOfRuns, names: tuple[str, ...], low: Floats, high: Floats
) -> tuple[tuple[Floats, Floats], list[Note]]:
    """K_1 and tau at the levels of each run from surfaces of E' and of the logarithm of E''."""
    missing = np.full(len(runs.run), np.nan)
    parts = np.array([line.storage_spring_constant, line.loss_spring_constant])
    try:
        smooth = fit_surfaces(
            runs.level, parts, factor_names=names, low=low, high=high, run_names=runs.names,
            response_names=("storage_spring_constant", "loss_spring_constant"),
            transforms=("none", "log"), blocks=_specimen_blocks(runs),
        )  # fmt: skip
    except REFUSALS as error:
        return (missing, missing), [note("no-derived-line", reason=str(error))]
    known = np.isfinite(runs.level).all(axis=1)
    # with the level of the specimen of each run, since its own K_0 is subtracted
    storage, loss = smooth.fitted[0], np.exp(smooth.fitted[1])
    if smooth.blocks is not None:
        known &= np.isfinite(smooth.blocks.effect[:, smooth.blocks.index]).all(axis=0)
    found = identify_by_fundamental(
        storage_spring_constant=storage[known],
        loss_spring_constant=loss[known],
        frequency=runs.frequency[known],
        quasi_static_spring_constant=line.quasi_static_spring_constant[known],
    )
    constant, time = missing.copy(), missing.copy()
    constant[known], time[known] = found.dissipation_spring_constant, found.relaxation_time
    return (constant, time), []


def _single_time_of_runs(
    runs: RunTable, coded: Floats, frequency: int, response_names: Sequence[str], line: LineOfRuns
) -> tuple[SingleTimeCheck | None, list[Note]]:
    """Test for a single relaxation time: runs at equal loads, as reached, are compared."""
    place = response_names.index("relaxation_time")
    time = runs.response[place]
    used = np.isfinite(time) & np.isfinite(coded).all(axis=1)
    if not used.any():
        return None, [note("no-check-of-single-time", reason="no run has one")]
    loads = replicate_cells(np.delete(coded, frequency, axis=1))
    group = [f"{one} {cell}" for one, cell in zip(runs.specimen, loads.tolist(), strict=True)]
    loss = line.loss_spring_constant / line.storage_spring_constant
    try:
        check = check_single_time(
            runs.frequency[used], time[used], loss[used],
            group=np.array(group)[used],
            relative_standard_uncertainty=(runs.response_standard_uncertainty[place] / time)[used],
        )  # fmt: skip
    except REFUSALS as error:
        return None, [note("no-check-of-single-time", reason=str(error))]
    return check, [note("single-time", verdict=VERDICTS[int(check.verdict)])]


_PREFIX: dict[str, Transform] = {
    "log_": "log", "box_cox_": "box-cox", "log_frequency_times_": "log-times-frequency"
}  # fmt: skip


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
    run_order: ArrayLike | None = None,
) -> ExperimentResult:
    """All results from the runs of one experiment."""
    low, high = (np.array([getattr(one, end) for one in factors]) for end in ("low", "high"))
    notes = _remarks_of_runs(runs)
    coded = coded_from_engineering(runs.level, low=low, high=high)
    surfaces: ResponseSurfaces | None = None
    screening: ScreeningEffects | None = None
    forms: tuple[StiffnessForm, ...] = ()
    quality: FormQuality | None = None
    single: SingleTimeCheck | None = None
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
            notes += _levels_off_plan(runs, coded, names, code="levels-off-plan", noted=ON_PLAN)
            scales, remarks = _scales(runs, names, low, high, response_names, transform)
            notes += remarks
            surfaces = _surfaces(runs, names, low, high, response_names, scales, specimens_as)
    except REFUSALS as error:
        what = "effects" if kind == "plackett-burman" else "response surfaces"
        notes.append(note("no-main-part", part=what, reason=str(error)))
        refusal_status = error.exit_status
    if surfaces is not None:
        notes += _missing_surfaces(runs, surfaces, response_names)
        notes += surfaces.notes
        notes += negative_surfaces(surfaces)
        notes += outlying_runs(surfaces)
        drift = drift_over_order(surfaces, _places_in_order(runs, run_order))
        notes += drifting_responses(surfaces, drift)
        if not set(LINE_PARAMETERS).isdisjoint(response_names):
            notes.append(note("slow-pull-error-shared"))
        forms, quality, remarks = _stiffness_of_runs(runs, surfaces, response_names)
        notes += remarks
        derived, remarks = _derived_line(runs, line, names, low, high)
        notes += remarks
    if "frequency" in names and "relaxation_time" in response_names:
        single, remarks = _single_time_of_runs(
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
        cautions=_cautions_of_runs(runs, factors, run_order),
        notes=tuple(dict.fromkeys(notes)),
        refusal_status=refusal_status,
    )


def _screening(
    runs: RunTable, coded: Floats, names: tuple[str, ...], response_names: tuple[str, ...]
) -> tuple[ScreeningEffects, list[Note]]:
    """Effects by the plan, if the runs kept to it."""
    notes = _levels_off_plan(
        runs, coded, names, code="screening-levels-off-plan", noted=_OFF_SCREENING
    )
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
                note(
                    "no-effect",
                    responses=_listed(responses),
                    reason=reason,
                    without=_listed(without),
                )
            )
    return effects, notes + screening_remarks(
        design.dummy.shape[1], _specimen_blocks(runs) is not None
    )


_LOGARITHMIC = ("hysteresis_energy", "relaxation_time")
"""Positive by nature and spread over decades: fitted as logarithms, unless the runs object."""


def _scales(
    runs: RunTable,
    names: tuple[str, ...],
    low: Floats,
    high: Floats,
    response_names: tuple[str, ...],
    stated: Mapping[str, str],
) -> tuple[dict[str, str], list[Note]]:
    """Scale of each response: the stated one, else the usual one unless the runs reject it.

    Scatter about a surface of logarithms is compared with that about a surface as measured over
    the geometric mean of the runs (Box and Cox).  The other scale is used where the usual one has
    so much more scatter that a ratio of two variances of equal degrees of freedom would be as large
    in one case of twenty.  A time is fitted as product with the frequency where a quadratic then
    has a smaller misfit (`_with_frequency`).
    """
    scales = dict(stated)
    notes: list[Note] = []
    free = [index for index, one in enumerate(response_names) if one not in stated]
    values = runs.response[free]
    has = np.isfinite(values).any(axis=1) & ~np.any(values <= 0, axis=1)
    free = [index for index, one in zip(free, has.tolist(), strict=True) if one]
    if not free:
        return scales, notes

    def fit(values: Floats, chosen: list[str], transforms: list[Transform]) -> ResponseSurfaces:
        return fit_surfaces(
            runs.level, values, factor_names=names, response_names=chosen, low=low, high=high,
            run_names=runs.names, blocks=_specimen_blocks(runs), pulls=runs.run,
            transforms=transforms, with_tests=False,
        )  # fmt: skip

    ratios, chances = scatter_by_scale(runs.response[free], fit)
    for index, ratio, p in zip(free, ratios.tolist(), chances.tolist(), strict=True):
        name = response_names[index]
        usual: Transform = "log" if name in _LOGARITHMIC else "none"
        of_usual = ratio if usual == "log" else 1 / ratio
        objects = p < OBJECTS and of_usual > 1
        scales[name] = {"none": "log", "log": "none"}[usual] if objects else usual
        if objects:
            to, about = "its logarithm", "the untransformed surface"
            if usual == "log":
                to, about = "the response as measured", "the surface of its logarithm"
            notes.append(
                note("scale-by-runs", response=name, scale=to, about=about, ratio=of_usual, p=p)
            )
    times = [one for one in _TIMES if scales.get(one) == "log" and one not in stated]
    if times and "frequency" in names and low[names.index("frequency")] > 0:
        scales |= _with_frequency(runs, names, low, high, response_names, times)
    return scales, notes


_TIMES = ("relaxation_time", "dashpot_coefficient")
"""Responses that fall as 1/f where the loss angle is constant."""


def _with_frequency(
    runs: RunTable,
    names: tuple[str, ...],
    low: Floats,
    high: Floats,
    response_names: tuple[str, ...],
    times: list[str],
) -> dict[str, str]:
    """Responses that are fitted as products with the frequency, where the misfit is then smaller.

    Three levels of the frequency fit the logarithm of a power of it without residuals, whatever
    its exponent, so that scatter cannot decide.  The decision is by the possible misfit between the
    levels: the root mean square of the discrepancy over a grid of the tested range.
    """
    on_log: Transform = "log"
    on_product: Transform = "log-times-frequency"
    rows = [response_names.index(one) for one in times]
    trial = fit_surfaces(
        runs.level, runs.response[2 * rows], factor_names=names, low=low, high=high,
        response_names=[f"{scale} {one}" for scale in (on_log, on_product) for one in times],
        run_names=runs.names, blocks=_specimen_blocks(runs), pulls=runs.run, with_tests=False,
        transforms=[scale for scale in (on_log, on_product) for _ in times],
    )  # fmt: skip
    grid = np.array(list(product(np.linspace(-1, 1, 5), repeat=len(names))))
    missed = np.mean(discrepancy_of(trial).at(grid) ** 2, axis=1).reshape(2, len(times))
    return {one: on_product for one, less in zip(times, missed[1] < missed[0], strict=True) if less}


def _surfaces(
    runs: RunTable,
    names: tuple[str, ...],
    low: Floats,
    high: Floats,
    response_names: tuple[str, ...],
    transform: Mapping[str, str],
    specimens_as: Literal["blocks", "random"],
) -> ResponseSurfaces:
    """Surfaces of every response, then of each one required on another scale."""
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
        blocks=_specimen_blocks(runs),
        pulls=runs.run,
        block_treatment="fixed" if specimens_as == "blocks" else "random",
        transforms=scales,
    )
