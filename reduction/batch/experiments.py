"""Experiments of a campaign from the archives of their runs."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from reduction import __version__
from reduction.archive.open import Opener, reading
from reduction.archive.surfaces import surfaces_to_dataset
from reduction.archive.write import write_archive
from reduction.batch.part import PartStatus
from reduction.batch.planned import same_logs
from reduction.batch.runrows import LINE, MEASURED, Row, rows_of_run
from reduction.batch.standing import waiting_in_words
from reduction.campaign.plan import Campaign, ExperimentPlan
from reduction.errors import FitError
from reduction.experiment import ExperimentResult, RunTable
from reduction.ingest.source import hash_source
from reduction.notes import by_severity
from reduction.pipeline.experiment import fit_experiment
from reduction.pipeline.runline import LineOfRuns
from reduction.pipeline.shared.surface import with_shared_surfaces
from reduction.provenance import Origin, Source, Step
from reduction.record import Floats
from reduction.surface.levels import FactorLevels
from reduction.uncertainty.product import Contributions
from reduction.vocabulary import quantity

_UNITS = {"temperature": "K", "diameter": "m"}
# notes of which the message tells the first: without that part there is little to read
_MAIN_PART = ("refused: response surfaces", "refused: effects", "refused: surface of")


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
    """Fit the experiments of a campaign of which no run waits, and write them as one archive.

    Parameters
    ----------
    campaign : Campaign
        With its experiments; nothing is written where it has none.
    folder : pathlib.Path
        Of the campaign's archives, of which one is made.
    failed : collection of str
        Tests whose archive, where there is one, is of an earlier run and not used.
    waiting : collection of str
        Runs that were not asked for and have to be reduced first.
    raw_sha256 : mapping of str to str
        Hashes of the raw files by run.
    command : str
        For the product's ``command`` attribute.
    opener : Opener
        How archives are opened.

    Returns
    -------
    statuses : list of PartStatus
        One an experiment.

    Raises
    ------
    ArchiveError
        If the archive cannot be written, or that of a run cannot be read.
    """
    if not campaign.experiments:
        return []
    held = {
        name: waiting_in_words(waiting, plan.runs) for name, plan in campaign.experiments.items()
    }

    def archive_of(run: str) -> Path | None:
        return None if run in failed else folder / f"{run}.nc"

    empty = {
        name: _nothing_to_fit(plan)
        for name, plan in campaign.experiments.items()
        if not (held[name] or any(_is_there(archive_of(run)) for run in plan.runs))
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
    results, sources = fit_experiments(
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
    write_archive(dataset, path)
    statuses |= {result.name: _status(result) for result in results}
    return list(statuses.values())


def settings_of_experiments(plans: Mapping[str, ExperimentPlan]) -> str:
    """Every setting of experiments, as JSON: the attribute ``settings`` of their archive."""
    return json.dumps({name: asdict(plan) for name, plan in plans.items()}, sort_keys=True)


def _is_there(path: Path | None) -> bool:
    return path is not None and path.exists()


def _nothing_to_fit(plan: ExperimentPlan) -> FitError:
    """What is wrong with an experiment none of whose runs gave a product."""
    return FitError(
        "there is nothing to fit",
        found=f"no product of any of its {len(plan.runs)} runs",
        hint="The messages of its runs say why.",
    )


def _in_one_line(result: ExperimentResult) -> str:
    done = int(np.isfinite(result.runs.response).any(axis=0).sum())
    return f"{result.name}: {done} of {len(result.runs.run)} runs of a {result.kind} design"


def _status(result: ExperimentResult) -> PartStatus:
    """A design whose main part the runs do not carry has failed, as the error of it says."""
    failed = result.refusal_status != 0
    main = [note for note in result.notes if note.startswith(_MAIN_PART)]
    ranked = [text for _, text in by_severity(("experiment", note) for note in result.notes)]
    # what is missing, and the worst of what else there is to know
    said = [*main[:1], *[note for note in ranked if note not in main][:1]]
    message = "; ".join([_in_one_line(result), *said])
    status = "failed" if failed else "fitted_with_notes" if result.notes else "fitted"
    return PartStatus(result.name, status, result.refusal_status, message)


def fit_experiments(
    campaign: Campaign,
    archive_of: Callable[[str], Path | None],
    *,
    raw_sha256: Mapping[str, str],
    opener: Opener = reading,
) -> tuple[list[ExperimentResult], tuple[Source, ...]]:
    """Fit every experiment of a campaign.

    Parameters
    ----------
    campaign : Campaign
        With its experiments.
    archive_of : callable
        Path of a run's archive by the run's id, which need not exist; None for a run that failed.
    raw_sha256 : mapping of str to str
        Hashes of the raw files by run.
    opener : Opener
        How archives are opened.

    Returns
    -------
    results : list of ExperimentResult
        In the order of the campaign.
    sources : tuple of Source
        The archives that were read, by name, with their hashes.
    """
    results, sources = [], {}
    for plan in campaign.experiments.values():
        rows = [
            row
            for run, coded in plan.runs.items()
            for row in rows_of_run(campaign, plan, run, coded, archive_of(run), opener)
        ]
        for run in plan.runs:
            path = archive_of(run)
            if path is not None and path.exists():
                sources[path.name] = hash_source(path, path.name)
        result = fit_rows(plan, rows)
        results.append(replace(result, notes=(*result.notes, *same_logs(plan, raw_sha256))))
    return results, tuple(sources.values())


def _column(rows: list[Row], name: str) -> Floats:
    return np.array([row.get(name, np.nan) for row in rows], dtype=np.float64)


def _levels(
    plan: ExperimentPlan, rows: list[Row]
) -> tuple[tuple[FactorLevels, ...], tuple[str, ...], Floats]:
    """Factors in one unit, their units, and the levels as reached, shape (n_runs, n_factors)."""
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
            # lines of one strength: the surface is in newtons
            factor = FactorLevels(name, factor.low * known[0], factor.high * known[0])
        elif factor.basis == "rated_break_strength":
            reached, unit = reached / strengths, "1"
        factors.append(factor)
        units.append(unit)
        columns.append(reached)
    return tuple(factors), tuple(units), np.stack(columns, axis=1)


def fit_rows(plan: ExperimentPlan, rows: list[Row]) -> ExperimentResult:
    """Fit one experiment to what its runs gave, one row a run and specimen."""
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
        remark=tuple(row["remark"] for row in rows),
        shared=_shared(plan, rows),
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
        term_reduction=plan.term_reduction,
        run_order=_column(rows, "order"),
    )
    return with_shared_surfaces(result)


def _shared(plan: ExperimentPlan, rows: list[Row]) -> Contributions | None:
    """What errors that runs share add to their responses, and to the levels as reached."""
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
    # the levels follow from means of the run, and are theirs or ratios of them
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
