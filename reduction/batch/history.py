"""What each specimen had seen before a test, from the order of its tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.batch.survey import Survey
from reduction.moduli.slack import slack_crossings
from reduction.product import History
from reduction.strain.fit import free_length_strain_of
from reduction.strain.model import StrainModel

__all__ = ["history_of", "history_remarks"]


def _greatest_strain(survey: Survey, name: str, model: StrainModel) -> float:
    """Greatest strain: measured, or at one of the samples at the greatest position."""
    if model.method == "extensometer":
        return survey.greatest_measured_strain.get(name, float("nan"))
    position, tension, _ = survey.greatest[name]
    return float(np.nanmax(free_length_strain_of(model, position=position, tension=tension)))


def _set_after_rest(
    survey: Survey, earlier: Sequence[Survey], name: str, free_length: float
) -> tuple[float, float]:
    """Growth of the length at which the specimen becomes taut, since its first test. [1]."""
    if not earlier:
        return float("nan"), float("nan")
    first = min(earlier, key=lambda entry: (entry.plan.order or 0, entry.plan.step_place))
    pair = (first, survey)
    if any(name not in entry.first_rise for entry in pair):
        return float("nan"), float("nan")
    # one tension for both, so that the slope of the first rise does not enter
    slack = max(entry.slack_tension for entry in pair)
    lengths, spreads = [], []
    for entry in pair:
        position, tension = entry.first_rise[name]
        crossing, crossing_spread, _ = slack_crossings(position, tension, slack_tension=slack)
        lengths.append(crossing[0])
        spreads.append(crossing_spread[0])
    growth, spread = (lengths[1] - lengths[0]) / free_length, np.hypot(*spreads) / free_length
    # a crossing through two samples alone has no residual, and so no uncertainty to give
    if not np.isfinite(spread):
        return float("nan"), float("nan")
    return float(growth), float(spread)


def history_of(
    survey: Survey,
    surveys: Sequence[Survey],
    models: Mapping[tuple[str, str], StrainModel],
) -> History | None:
    """Earlier maximum strain and tension and cumulative cycles of each specimen.

    Parameters
    ----------
    survey : Survey
        The test; one that is a part of another has the history of that one.
    surveys : sequence of Survey
        All tests of the campaign.
    models : mapping of (test, specimen) to StrainModel
        How position becomes strain.

    Returns
    -------
    history : History or None
        None where the test has no place in the order.
    """
    by_log = {entry.plan.log: entry for entry in surveys}
    order = survey.plan.order
    if survey.plan.part_of in by_log:
        order = by_log[survey.plan.part_of].plan.order
    if order is None:
        return None
    place = (order, survey.plan.step_place)
    tests: list[tuple[str, ...]] = []
    strain, tension, cycles, left = [], [], [], []
    for name in survey.plan.specimens:
        earlier = [
            entry
            for entry in surveys
            if entry.plan.order is not None
            and (entry.plan.order, entry.plan.step_place) < place
            and entry.plan.part_of is None
            and name in entry.plan.specimens
        ]
        seen = [entry for entry in earlier if name in entry.greatest]
        strains = [
            _greatest_strain(entry, name, models[entry.plan.id, name])
            for entry in seen
            if (entry.plan.id, name) in models
        ]
        tests.append(tuple(entry.plan.id for entry in earlier))
        strain.append(float(np.max(strains)) if strains else float("nan"))
        tension.append(max((entry.greatest[name][2] for entry in seen), default=float("nan")))
        cycles.append(float(sum(entry.n_cycles for entry in earlier)))
        model = models.get((survey.plan.id, name))
        free = float("nan") if model is None else model.coefficients.get("relaxed_free_length")
        left.append(_set_after_rest(survey, seen, name, float("nan") if free is None else free))
    return History(
        earlier_tests=tuple(tests),
        earlier_maximum_strain=np.array(strain),
        earlier_maximum_tension=np.array(tension),
        earlier_cycles=np.array(cycles),
        permanent_set=np.array([value for value, _ in left]),
        permanent_set_standard_uncertainty=np.array([spread for _, spread in left]),
    )


def history_remarks(survey: Survey, surveys: Sequence[Survey]) -> tuple[str, ...]:
    """What the campaign leaves open about the place of a test in its specimens' history.

    Parameters
    ----------
    survey : Survey
        The test.
    surveys : sequence of Survey
        All tests of the campaign.

    Returns
    -------
    remarks : tuple of str
        Sentences for a reader of the product; empty where nothing is open.
    """
    plan = survey.plan
    if plan.part_of is not None:
        return (
            f"a part of {plan.part_of}: its history is that of the whole; cycles of the whole "
            "before this part are not counted",
        )
    shared = [
        name
        for name in plan.specimens
        if any(name in other.plan.specimens for other in surveys if other.plan.log != plan.log)
    ]
    if plan.order is None and shared:
        return (
            f"no place in the order of tests is given for {', '.join(shared)}: what earlier tests "
            "did to the rubber is not known here; set order",
        )
    return ()
