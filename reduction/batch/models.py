"""Strain models of a campaign: the marks of a specimen pooled over its tests."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from reduction.batch.survey import Survey, as_reduction_error
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError
from reduction.record import Floats, SpliceMarks
from reduction.strain.fit import fit_strain_model
from reduction.strain.model import StrainModel


def _pooled(
    marks: SpliceMarks, surveys: Sequence[Survey], measured: Callable[[Survey], dict[str, Floats]]
) -> Floats:
    """One tension a mark, in the order of the marks; NaN where its test could not be read."""
    tension = np.full(len(marks.test), np.nan)
    of_test = np.array(marks.test)
    for survey in surveys:
        values = measured(survey).get(marks.specimen)
        if values is not None:
            tension[of_test == survey.plan.log] = values
    return tension


def _failed_logs(surveys: Sequence[Survey]) -> tuple[str, ...]:
    """Logs of which nothing could be read, so that no mark in them has a tension."""
    sound = {survey.plan.log for survey in surveys if survey.error is None or survey.mark_tension}
    return tuple(dict.fromkeys(s.plan.log for s in surveys if s.plan.log not in sound))


def _load_cells(campaign: Campaign, surveys: Sequence[Survey], specimen: str) -> dict[str, str]:
    """By log, the load cell under which the marks of a specimen were read in it."""
    return {
        survey.plan.log: campaign.uncertainty.load_cell_name(
            survey.plan.attributes.get("load_cell", ""),
            channel=survey.plan.specimens.index(specimen) + 1,
        )
        for survey in surveys
        if specimen in survey.plan.specimens
    }


def fit_strain_models(
    campaign: Campaign, surveys: Sequence[Survey]
) -> tuple[dict[tuple[str, str], StrainModel], dict[str, ReductionError]]:
    """Fit the strain model of each specimen in each test.

    Parameters
    ----------
    campaign : Campaign
        With the pooled marks.
    surveys : sequence of Survey
        With the tension at the marks.

    Returns
    -------
    models : dict of (test, specimen) to StrainModel
        Tests whose log could not be read are left out.
    errors : dict of test to ReductionError
        Tests that have no way from position to strain.
    """
    at_end = {
        name: _pooled(marks, surveys, lambda survey: survey.mark_tension)
        for name, marks in campaign.marks.items()
    }
    at_start = {
        name: _pooled(marks, surveys, lambda survey: survey.mark_tension_at_start)
        for name, marks in campaign.marks.items()
    }
    cells = {name: _load_cells(campaign, surveys, name) for name in campaign.specimens}
    failed = _failed_logs(surveys)
    models: dict[tuple[str, str], StrainModel] = {}
    errors: dict[str, ReductionError] = {}
    for survey in surveys:
        if survey.error is not None or survey.plan.kind == "stepwise":
            continue
        for name in survey.plan.specimens:
            try:
                model = fit_strain_model(
                    campaign.specimens[name],
                    test_id=survey.plan.log,
                    marks=campaign.marks.get(name),
                    mark_tension=at_end.get(name),
                    mark_tension_at_start=at_start.get(name),
                    settings=survey.plan.settings.strain,
                    has_extensometer=survey.extremes.has_extensometer,
                    reference_position=survey.zero_strain_position,
                    failed_tests=failed,
                )
                read_by = tuple(cells[name].get(test, "") for test in model.mark_test)
                models[survey.plan.id, name] = replace(
                    model,
                    mark_load_cell=read_by,
                    is_zero_logged=survey.is_zero_logged and model.method == "gauge-length",
                )
            except Exception as error:
                # one test's failure, even where it is a defect here
                errors.setdefault(survey.plan.id, as_reduction_error(error))
    return models, errors
