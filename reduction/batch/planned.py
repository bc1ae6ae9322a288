"""Experiments before they are run: what a check says of their runs, pulls and lowest tensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from reduction.batch.pulls import pull_tests
from reduction.batch.status import TestStatus
from reduction.campaign.plan import Campaign, ExperimentPlan
from reduction.surface.cautions import NEAR_ZERO
from reduction.surface.levels import engineering_levels


def experiments_found(campaign: Campaign, tests: Sequence[TestStatus]) -> list[dict[str, Any]]:
    """What a check says of every experiment.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    tests : sequence of TestStatus
        Of the tests that were checked.

    Returns
    -------
    found : list of dict
        One an experiment, as the JSON answer has it.
    """
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
            "notes": [*_without_pull(campaign, plan), *same_logs(plan, sums)],
        }
        for plan in campaign.experiments.values()
    ]


def _specimens(campaign: Campaign, run: str) -> tuple[str, ...]:
    return campaign.tests[run.partition(".")[0]].specimens


def _slack_runs(campaign: Campaign, plan: ExperimentPlan) -> list[dict[str, Any]]:
    """Runs and specimens whose minimum tension is planned at or below zero."""
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
    return [f"no slow pull of {', '.join(bare)}: K_0, and so K_1 and tau, are refused"]


def same_logs(plan: ExperimentPlan, raw_sha256: Mapping[str, str]) -> list[str]:
    """Runs of different tests whose logs are byte for byte the same.

    Parameters
    ----------
    plan : ExperimentPlan
        The experiment.
    raw_sha256 : mapping of str to str
        Hashes of the raw files by run.

    Returns
    -------
    notes : list of str
        One a log; steps of one test share its log and are not told of.
    """
    tests_of: dict[str, dict[str, None]] = {}
    for run in plan.runs:
        if raw_sha256.get(run):
            tests_of.setdefault(raw_sha256[run], {})[run.partition(".")[0]] = None
    return [
        f"{' and '.join(tests)} have the same log, byte for byte: one run that was copied under "
        "another name?"
        for tests in tests_of.values()
        if len(tests) > 1
    ]
