"""Fits the experiments of a campaign and writes surfaces.nc from the archives of the runs."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction import __version__
from reduction.archive.open import Opener, as_kept, keep_written, reading
from reduction.archive.shared_errors import shared_contributions
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.uncertainty_budget import break_in_cycles
from reduction.archive.variables import read_notes, stored
from reduction.archive.write import write_archive
from reduction.batch.campaign_status import PartStatus, TestStatus
from reduction.batch.plausibility import load_columns
from reduction.batch.reuse import NOT_REDUCED
from reduction.batch.slow_pulls import pull_tests
from reduction.campaign.plan import Campaign, ExperimentPlan
from reduction.experiments.designs import FactorLevels, engineering_levels
from reduction.experiments.experiment import ExperimentResult, RunTable
from reduction.experiments.experiment_fit import LineOfRuns, fit_experiment
from reduction.experiments.run_sheet import MEASURED_SLACK, NEAR_ZERO
from reduction.quantities.names import quantity
from reduction.readers.raw_log import hash_source
from reduction.record.contributions import Contributions
from reduction.record.errors import FitError
from reduction.record.measurement import Bools, Floats, Origin, Source, Step
from reduction.record.notes import Note, by_severity, note
from reduction.stages.three_parameter_line.line_product import LINE_PARAMETERS, REASONS
from reduction.uncertainty.surface_errors import with_shared_surfaces


def experiments_found(campaign: Campaign, tests: Sequence[TestStatus]) -> list[dict[str, Any]]:
    """Check results for every experiment."""
    is_read = {test.test: test.status != "failed" for test in tests}
    sums = {test.test: test.raw_sha256 for test in tests if is_read[test.test]}
    return [
        {
            "id": plan.name,
            "kind": plan.kind,
            "factors": [factor.name for factor in plan.factors],
            "runs": list(plan.runs),
            "runs_found": [run for run in plan.runs if is_read.get(run)],
            "runs_failed": [run for run in plan.runs if not is_read.get(run, True)],
            "quasi_static": [
                {"specimen": specimen, "test": test, "found": is_read.get(test)}
                for specimen, test in plan.quasi_static.items()
            ],
            "slack_runs": _slack_runs(campaign, plan),
            "notes": [*_without_pull(campaign, plan), *map(str, _same_logs(campaign, plan, sums))],
        }
        for plan in campaign.experiments.values()
    ]


def _specimens(campaign: Campaign, run: str) -> tuple[str, ...]:
    return campaign.tests[run.partition(".")[0]].specimens


def _slack_runs(campaign: Campaign, plan: ExperimentPlan) -> list[dict[str, Any]]:
    """Runs and specimens with a planned minimum tension at or below zero."""
    names = [factor.name for factor in plan.factors]
    if not {"mean_tension", "tension_amplitude"} <= set(names):
        return []
    rows = [
        (run, specimen, coded[: len(names)])
        for run, coded in plan.runs.items()
        for specimen in _specimens(campaign, run)
    ]
    strengths = [campaign.specimens[specimen].rated_break_strength for _, specimen, _ in rows]
    is_share = any(factor.basis == "rated_break_strength" for factor in plan.factors)
    levels = engineering_levels(
        [coded for _, _, coded in rows],
        plan.factors,
        rated_break_strength=np.array(strengths, dtype=np.float64) if is_share else None,
    )
    mean, amplitude = (levels[:, names.index(one)] for one in ("mean_tension", "tension_amplitude"))
    least = mean - amplitude
    least[np.abs(least) <= NEAR_ZERO * (mean + amplitude)] = 0.0
    return [
        {
            "run": rows[place][0],
            "specimen": rows[place][1],
            "planned_minimum_tension": {"value": float(least[place]), "unit": "N"},
        }
        for place in np.flatnonzero(least <= 0)
    ]


def _without_pull(campaign: Campaign, plan: ExperimentPlan) -> list[str]:
    bare = {
        specimen: None
        for run in plan.runs
        for specimen in _specimens(campaign, run)
        if specimen not in pull_tests(campaign, run)
    }
    if not bare:
        return []
    return [f"no slow pull of {', '.join(bare)}: K_0, K_1 and tau are not given"]


def _same_logs(
    campaign: Campaign, plan: ExperimentPlan, raw_sha256: Mapping[str, str]
) -> list[Note]:
    """Runs of different tests whose loads come from one log, byte for byte."""
    tests_of: dict[tuple[object, ...], dict[str, None]] = {}
    for run in plan.runs:
        if raw_sha256.get(run):
            log = campaign.tests[run.partition(".")[0]]
            loads = (load_columns(campaign.layouts[layout]) for _, layout in log.files)
            tests_of.setdefault((raw_sha256[run], *loads), {})[log.log] = None
    return [
        note("same-log", tests=" and ".join(tests)) for tests in tests_of.values() if len(tests) > 1
    ]


LINE = ("storage_spring_constant", "loss_spring_constant", "quasi_static_spring_constant")

MEASURED = ("frequency", "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude")

# key of REASONS: no quasi-static spring constant at the mean tension
_NO_REST = 1

# results of one run and specimen, by name
Row = dict[str, Any]


def _rows_of_run(
    campaign: Campaign,
    plan: ExperimentPlan,
    run: str,
    coded: tuple[float, ...],
    path: Path | None,
    opener: Opener = reading,
) -> list[Row]:
    """One row per specimen of a run; a run without an archive has a row that states this."""
    log = run.partition(".")[0]
    specimens = campaign.tests[log].specimens
    about = {"run": run, "coded": coded, "order": _order(campaign, plan, run)}
    if path is None or not path.exists():
        missing = note("run-test-failed" if path is None else "run-without-product")
        return [about | {"remarks": (missing,), "specimen": name} for name in specimens]
    # an unreadable archive is not a missing run: without it the surfaces would change
    with opener(path) as archive:
        given = [str(name) for name in archive.variables["specimen"].values]
        return [
            about | _row_of_archive(plan, archive, given.index(name), name) for name in specimens
        ]


def _order(campaign: Campaign, plan: ExperimentPlan, run: str) -> float:
    """Position of a run in time; NaN if the campaign does not state it."""
    log = run.partition(".")[0]
    test = campaign.tests[log]
    # the steps of one log are in time order
    is_one_log = all(other.partition(".")[0] == log for other in plan.runs)
    start = test.order if test.order is not None else 0 if test.steps and is_one_log else np.nan
    steps = [step.product(log) for step in test.steps]
    return float(start + (steps.index(run) / len(steps) if run in steps else 0.0))


def _row_of_archive(plan: ExperimentPlan, archive: xr.Dataset, place: int, specimen: str) -> Row:
    """Contents of a run's archive for one specimen."""

    def of_test(name: str) -> float:
        stated = stored(archive, f"test_{name}")
        return float("nan") if stated is None else float(stated.values[place])

    needs_pull = not set(LINE_PARAMETERS).isdisjoint(plan.responses)
    remarks = _refusal(plan, archive, place, specimen) if needs_pull else []
    row: Row = {name: of_test(name) for name in (*MEASURED, *LINE, *plan.responses)}
    for name in plan.responses:
        # shared errors are not scatter of the run: they are propagated separately, with their sign
        row[f"u {name}"] = of_test(f"{name}_random_standard_uncertainty")
        row[f"whole u {name}"] = of_test(f"{name}_standard_uncertainty")
        if np.isnan(row[f"u {name}"]):
            row[f"u {name}"] = row[f"whole u {name}"]
    row["shared"] = {
        name: shared_contributions(archive, f"test_{name}", place)
        for name in dict.fromkeys((*MEASURED, *plan.responses))
    }
    begin = break_in_cycles(archive)
    if "peak_tension" in archive:
        peak = archive.variables["peak_tension"].values[place, begin:]
        valley = archive.variables["valley_tension"].values[place, begin:]
        row["peak"], row["least"] = float(np.nanmax(peak)), float(np.nanmin(valley))
        remarks += _slack(valley <= MEASURED_SLACK * peak)
    strength = stored(archive, "rated_break_strength")
    row["strength"] = float("nan") if strength is None else float(strength.values[place])
    return row | {"specimen": specimen, "remarks": tuple(remarks)}


def _slack(is_slack: Bools) -> list[Note]:
    if not is_slack.any():
        return []
    return [note("run-slack", cycles="every cycle" if is_slack.all() else "some of its cycles")]


def _refusal(plan: ExperimentPlan, archive: xr.Dataset, place: int, specimen: str) -> list[Note]:
    """Reasons why a run has no K_1 and tau; empty if it has."""
    flags = stored(archive, "test_line_refusal")
    code = _NO_REST if flags is None else int(flags.values[place])
    if code == 0:
        return []
    reason, pull = REASONS[code], plan.quasi_static.get(specimen)
    notes = read_notes(archive)
    if code == _NO_REST and pull is None:
        reason = "no slow pull is named for the specimen"
    elif code == _NO_REST and any(
        one.code == "no-slow-pull" and f"specimen {place + 1} " in str(one) for one in notes
    ):
        reason = f"the slow pull {pull} gave no load-strain curve"
    elif code == _NO_REST and any(
        one.code == "mean-tension-outside-pull" and f"slow pull {specimen}," in str(one)
        for one in notes
    ):
        reason = f"the mean tension lies outside the slow pull {pull}"
    return [note("run-without-line", reason=reason)]


_UNITS = {"temperature": "K", "diameter": "m"}

# the first of these notes is the message: without that part little remains to read
_MAIN_PART = ("no-main-part", "no-effect", "no-surface")


_MANY = 4  # runs that are listed individually


def _outdated_in_words(waiting: Collection[str], runs: Collection[str]) -> str:
    """Runs needed before an experiment can be fitted, in words; empty if none."""
    listed = [run for run in runs if run in waiting]
    if not listed:
        return ""
    named = ", ".join(listed[:_MANY]) + (", .." if len(listed) > _MANY else "")
    return f"{len(listed)} of its runs {NOT_REDUCED} ({named})"


def write_experiments(
    campaign: Campaign,
    folder: Path,
    *,
    failed: Collection[str],
    waiting: Collection[str],
    raw_sha256: Mapping[str, str],
    command: str,
    opener: Opener = reading,
) -> list[PartStatus]:
    """Fit the experiments without pending runs, and write them as one archive."""
    if not campaign.experiments:
        return []
    held = {
        name: _outdated_in_words(waiting, plan.runs) for name, plan in campaign.experiments.items()
    }

    def archive_of(run: str) -> Path | None:
        return None if run in failed else folder / f"{run}.nc"

    empty = {
        name: FitError(
            "there is nothing to fit",
            found=f"no archive of any of its {len(plan.runs)} runs",
            hint="The messages of its runs say why.",
        )
        for name, plan in campaign.experiments.items()
        if not (held[name] or any((path := archive_of(run)) and path.exists() for run in plan.runs))
    }
    ready = {
        name: plan
        for name, plan in campaign.experiments.items()
        if not (held[name] or name in empty)
    }
    path = folder / "surfaces.nc"
    kept = "; surfaces.nc is of an earlier run" if path.exists() and not ready else ""
    statuses = {
        name: PartStatus(name, "failed", error.exit_status, f"{error}{kept}")
        if (error := empty.get(name)) is not None
        else PartStatus(name, "no_work", 0, f"not fitted: {words}{kept}")
        for name, words in held.items()
    }
    if not ready:
        return list(statuses.values())
    results, sources = _fit_experiments(
        replace(campaign, experiments=ready), archive_of, raw_sha256=raw_sha256, opener=opener
    )
    dataset = surfaces_to_dataset(
        results,
        origin=Origin(
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            sources=sources,
            steps=[Step("surfaces", _in_one_line(result)) for result in results],
            settings_json=settings_of_experiments(ready),
            version=__version__,
            command=command,
        ),
    )
    keep_written(opener, path, as_kept(write_archive(dataset, path)))
    statuses |= {result.name: _status(result) for result in results}
    return list(statuses.values())


def settings_of_experiments(plans: Mapping[str, ExperimentPlan]) -> str:
    """All settings of experiments as JSON: the attribute ``settings`` of their archive."""
    return json.dumps({name: asdict(plan) for name, plan in plans.items()}, sort_keys=True)


def _in_one_line(result: ExperimentResult) -> str:
    done = int(np.isfinite(result.runs.response).any(axis=0).sum())
    return f"{result.name}: {done} of {len(result.runs.run)} runs of a {result.kind} design"


def _status(result: ExperimentResult) -> PartStatus:
    """Status of an experiment; it has failed if the runs do not support its main part."""
    failed = result.refusal_status != 0
    main = [one for one in result.notes if one.code in _MAIN_PART]
    ranked = by_severity(one for one in result.notes if one.code not in _MAIN_PART)
    # the missing part, and the most serious other note
    message = "; ".join([_in_one_line(result), *map(str, (*main[:1], *ranked[:1]))])
    may_move = any(one.severity == "warning" for one in result.notes)
    status = "failed" if failed else "check" if may_move else "fitted"
    return PartStatus(result.name, status, result.refusal_status, message)


def _fit_experiments(
    campaign: Campaign,
    archive_of: Callable[[str], Path | None],
    *,
    raw_sha256: Mapping[str, str],
    opener: Opener = reading,
) -> tuple[list[ExperimentResult], tuple[Source, ...]]:
    """Fit every experiment of a campaign."""
    results, sources = [], {}
    for plan in campaign.experiments.values():
        rows = [
            row
            for run, coded in plan.runs.items()
            for row in _rows_of_run(campaign, plan, run, coded, archive_of(run), opener)
        ]
        for run in plan.runs:
            path = archive_of(run)
            if path is not None and path.exists():
                sources[path.name] = hash_source(path, path.name)
        result = _fit_rows(plan, rows)
        # a campaign with a slow pull expects K_1 and tau, so that their absence is explained first
        told = [
            replace(one, severity="warning")
            if one.code == "no-surface" and plan.quasi_static
            else one
            for one in result.notes
        ]
        results.append(replace(result, notes=(*told, *_same_logs(campaign, plan, raw_sha256))))
    return results, tuple(sources.values())


def _column(rows: list[Row], name: str) -> Floats:
    return np.array([row.get(name, np.nan) for row in rows], dtype=np.float64)


def _levels(
    plan: ExperimentPlan, rows: list[Row]
) -> tuple[tuple[FactorLevels, ...], tuple[str, ...], Floats]:
    """Factors in one unit, their units, and the achieved levels, shape (n_runs, n_factors)."""
    strengths = _column(rows, "strength")
    known = np.unique(strengths[np.isfinite(strengths)])
    factors, units, columns = [], [], []
    for index, factor in enumerate(plan.factors):
        name = factor.name
        coded = np.array([row["coded"][index] for row in rows])
        centre, half = (factor.low + factor.high) / 2, (factor.high - factor.low) / 2
        unit = quantity(name).unit if name in MEASURED else _UNITS.get(name, "1")
        reached = _column(rows, name) if name in MEASURED else centre + coded * half
        if factor.basis == "mean_tension":
            reached, unit = reached / _column(rows, "mean_tension"), "1"
        elif factor.basis == "rated_break_strength" and known.size == 1:
            # all lines have the same strength: the surface is in newtons
            factor = FactorLevels(name, factor.low * known[0], factor.high * known[0])
        elif factor.basis == "rated_break_strength":
            reached, unit = reached / strengths, "1"
        factors.append(factor)
        units.append(unit)
        columns.append(reached)
    return tuple(factors), tuple(units), np.stack(columns, axis=1)


def _fit_rows(plan: ExperimentPlan, rows: list[Row]) -> ExperimentResult:
    """Fit one experiment to the results of its runs, one row per run and specimen."""
    factors, units, level = _levels(plan, rows)
    runs = RunTable(
        run=tuple(row["run"] for row in rows),
        specimen=tuple(row["specimen"] for row in rows),
        coded_plan=np.array([row["coded"] for row in rows], dtype=np.float64),
        level=level,
        response=np.array([_column(rows, name) for name in plan.responses]),
        response_standard_uncertainty=np.array(
            [_column(rows, f"u {name}") for name in plan.responses]
        ),
        frequency=_column(rows, "frequency"),
        mean_tension=_column(rows, "mean_tension"),
        tension_amplitude=_column(rows, "tension_amplitude"),
        peak_tension=_column(rows, "peak"),
        minimum_tension=_column(rows, "least"),
        rated_break_strength=_column(rows, "strength"),
        remarks=tuple(row["remarks"] for row in rows),
        shared=_shared(plan, rows),
        response_whole_uncertainty=np.array(
            [_column(rows, f"whole u {name}") for name in plan.responses]
        ),
    )
    result = fit_experiment(
        runs,
        LineOfRuns(*(_column(rows, name) for name in LINE)),
        name=plan.name,
        kind=plan.kind,
        factors=factors,
        factor_units=units,
        response_names=plan.responses,
        transform=plan.transform,
        specimens_as=plan.specimens_as,
        run_order=_column(rows, "order"),
    )
    return with_shared_surfaces(result)


def _shared(plan: ExperimentPlan, rows: list[Row]) -> Contributions | None:
    """Contributions of shared errors to the responses and achieved levels of the runs."""
    given = [row.get("shared", {}) for row in rows]
    component = tuple(sorted({one for row in given for own in row.values() for one in own}))
    if not component:
        return None
    names = dict.fromkeys((*MEASURED, *plan.responses))
    tables = {
        name: np.array([[row.get(name, {}).get(one, 0.0) for row in given] for one in component])
        for name in names
    }
    values = {name: tables[name] for name in plan.responses}
    # levels are means over the run, or ratios of such means
    sides = [
        [
            _levels(plan, _moved(rows, {name: way * tables[name][place] for name in MEASURED}))[2]
            for place in range(len(component))
        ]
        for way in (1, -1)
    ]
    change = (np.array(sides[0]) - np.array(sides[1])) / 2
    values |= {factor.name: change[..., place] for place, factor in enumerate(plan.factors)}
    return Contributions(component, values)


def _moved(rows: list[Row], by: Mapping[str, Floats]) -> list[Row]:
    return [
        row | {name: row.get(name, np.nan) + float(step[place]) for name, step in by.items()}
        for place, row in enumerate(rows)
    ]
