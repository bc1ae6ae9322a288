"""Fits the slow pulls of a campaign: the quasi-static spring constant for each experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reduction.batch.campaign_status import Progress
from reduction.batch.survey import (
    FirstPass,
    Survey,
    as_reduction_error,
    located_again,
    with_one_log,
    with_record,
)
from reduction.batch.test_history import instruments_of
from reduction.batch.workers import Task, Workers, work_on
from reduction.campaign.plan import Campaign
from reduction.pipeline.located_test import strain_of_record
from reduction.pipeline.rope_test import PullConditions, pull_specimens
from reduction.quantities.units import parse_quantity
from reduction.record.errors import ReductionError
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.uncertainty.errors_of_cycles import PullOrigin

Pulls = Mapping[tuple[str, str], SlowPull]

_Found = tuple[list[SlowPull | None], ReductionError | None]


def pull_conditions(campaign: Campaign, survey: Survey) -> PullConditions:
    """Conditions of a slow pull stated in the campaign."""
    waiting = survey.plan.attributes.get("rest", "")
    try:
        waiting_time = parse_quantity(waiting, "time") if waiting else None
    except ReductionError:
        waiting_time = None
    channel = next(
        (
            campaign.layouts[layout].channels["crosshead_position"]
            for _, layout in survey.plan.files
            if "crosshead_position" in campaign.layouts[layout].channels
        ),
        None,
    )
    length = None if channel is None else channel.reference_length
    tension = None if channel is None else channel.reference_tension
    return PullConditions(
        waiting=waiting,
        waiting_time=waiting_time,
        reference_length=None if length is None else parse_quantity(length, "length"),
        reference_tension=None if tension is None else parse_quantity(tension, "force"),
    )


def fit_pulls(
    campaign: Campaign,
    first: FirstPass,
    models: Mapping[tuple[str, str], StrainModel],
    *,
    workers: Workers | None = None,
    progress: Progress,
) -> tuple[dict[tuple[str, str], SlowPull], dict[str, ReductionError]]:
    """Fit every slow pull named by an experiment."""
    named = {test for plan in campaign.experiments.values() for test in plan.quasi_static.values()}
    specimens_of: dict[str, tuple[str, ...]] = {}
    tasks: list[Task] = []
    for survey in first.surveys:
        test = survey.plan.id
        of_test = [models.get((test, name)) for name in survey.plan.specimens]
        known = [model for model in of_test if model is not None]
        if test not in named or survey.error is not None or len(known) < len(of_test):
            continue
        specimens_of[test] = survey.plan.specimens
        kept = first.kept.get(survey.plan.log)
        given = (with_one_log(campaign, survey.plan.log), survey, kept, known)
        tasks.append(Task(test, given, survey.n_rows))
    if tasks:
        progress.stage("slow pulls", len(tasks))
    pulls: dict[tuple[str, str], SlowPull] = {}
    errors: dict[str, ReductionError] = {}
    for ended in work_on(_fit, tasks, workers=workers, begun=progress.begun):
        found, error = ended.value or ([], ended.error)
        if error is not None:
            errors[ended.test] = error
        for name, pull in zip(specimens_of[ended.test], found, strict=False):
            if pull is not None:
                pulls[ended.test, name] = pull
        progress.ended(ended.test)
    return pulls, errors


def _fit(
    campaign: Campaign,
    survey: Survey,
    kept: Sequence[Survey] | None,
    models: Sequence[StrainModel],
) -> _Found:
    """Slow pull of each specimen of a test, or the error."""
    try:
        located = located_again(campaign, with_record(survey, kept))
        position, tension = located.position, located.tension
        strain = strain_of_record(located.record, position, tension, models)
        found, _ = pull_specimens(
            located, strain, tension, pull_conditions(campaign, survey), models=models
        )  # fmt: skip
    except Exception as error:
        # fails only this test, even for a defect of this program
        return [], as_reduction_error(error)
    return list(found), None


def pull_tests(campaign: Campaign, run: str) -> dict[str, str]:
    """Test with the slow pull by specimen, according to the experiments of the run."""
    return {
        specimen: test
        for plan in campaign.experiments.values()
        if run in plan.runs
        for specimen, test in plan.quasi_static.items()
    }


def pulls_of(campaign: Campaign, survey: Survey, pulls: Pulls) -> list[SlowPull | None] | None:
    """Slow pull of each specimen of a run; None if the test is not in any experiment."""
    if not any(survey.plan.id in plan.runs for plan in campaign.experiments.values()):
        return None
    test_of = pull_tests(campaign, survey.plan.id)
    return [pulls.get((test_of.get(name, ""), name)) for name in survey.plan.specimens]


def origins_of(
    campaign: Campaign,
    survey: Survey,
    surveys: Sequence[Survey],
    models: Mapping[tuple[str, str], StrainModel],
) -> tuple[PullOrigin | None, ...]:
    """Instruments of the slow pull of each specimen of a run; None without a pull."""
    test_of = pull_tests(campaign, survey.plan.id)
    by_test = {entry.plan.id: entry for entry in surveys}
    found: list[PullOrigin | None] = []
    for name in survey.plan.specimens:
        pulled = by_test.get(test_of.get(name, ""))
        of_pull = (
            []
            if pulled is None
            else [models.get((pulled.plan.id, one)) for one in pulled.plan.specimens]
        )
        known = [model for model in of_pull if model is not None]
        if pulled is None or not known or len(known) < len(of_pull):
            found.append(None)
            continue
        place = pulled.plan.specimens.index(name)
        found.append(PullOrigin(instruments_of(campaign, pulled, known)[place], known[place]))
    return tuple(found)
